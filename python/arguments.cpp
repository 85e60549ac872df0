#include "arguments.hpp"

#include <limits>

namespace py = pybind11;

namespace sandglass {
namespace {

std::string type_of(const py::handle& value) {
  return py::str(py::type::of(value).attr("__name__")).cast<std::string>();
}

[[noreturn]] void refuse(const char* name, const char* rule, const py::handle& value) {
  PyErr_Clear();
  throw py::type_error(std::string(name) + " must be " + rule + ", but is a " + type_of(value));
}

std::string text_of(const char* name, const char* rule, const py::handle& value) {
  if (PyUnicode_Check(value.ptr()) == 0) refuse(name, rule, value);
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (text == nullptr) refuse(name, "a text that UTF-8 can hold", value);
  if (std::string_view(text, static_cast<std::size_t>(size)).find('\0') != std::string_view::npos)
    refuse(name, "a text without zeros", value);
  return {text, static_cast<std::size_t>(size)};
}

/// Integers of Python and NumPy, but no flags.
int integer_of(const char* name, const char* rule, const py::handle& value) {
  if (PyBool_Check(value.ptr()) != 0 || PyIndex_Check(value.ptr()) == 0) refuse(name, rule, value);
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!index) refuse(name, rule, value);
  int overflow = 0;
  const long number = PyLong_AsLongAndOverflow(index.ptr(), &overflow);
  const bool fits =
      overflow == 0 && number >= std::numeric_limits<int>::min() && number <= std::numeric_limits<int>::max();
  if (!fits) throw py::type_error(std::string(name) + " must be in [-2^31, 2^31)");
  return static_cast<int>(number);
}

/// The entries of a list or tuple.
std::vector<py::object> entries_of(const char* name, const char* rule, const py::object& value) {
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value)) refuse(name, rule, value);
  std::vector<py::object> entries;
  for (const py::handle entry : value) entries.push_back(py::reinterpret_borrow<py::object>(entry));
  return entries;
}

}  // namespace

py::object Arguments::value(const char* name) const {
  if (!given_.contains(name)) throw py::type_error(std::string(name) + " is missing");
  return given_[name];
}

std::string Arguments::text(const char* name) const {
  return text_of(name, "a text", value(name));
}

std::string Arguments::path(const char* name) const {
  const py::object given = value(name);
  const auto text = py::reinterpret_steal<py::object>(PyOS_FSPath(given.ptr()));
  if (!text) refuse(name, "a path", given);
  return text_of(name, "a path", text);
}

double Arguments::number(const char* name) const {
  const py::object given = value(name);
  if (PyBool_Check(given.ptr()) != 0 || PyUnicode_Check(given.ptr()) != 0) refuse(name, "a number", given);
  const double number = PyFloat_AsDouble(given.ptr());
  if (PyErr_Occurred() != nullptr) refuse(name, "a number", given);
  return number;
}

int Arguments::integer(const char* name) const {
  return integer_of(name, "an integer", value(name));
}

bool Arguments::flag(const char* name) const {
  const py::object given = value(name);
  if (PyBool_Check(given.ptr()) == 0) refuse(name, "True or False", given);
  return given.ptr() == Py_True;
}

std::vector<std::string> Arguments::texts(const char* name) const {
  std::vector<std::string> all;
  for (const auto& entry : entries_of(name, "a list of texts", value(name)))
    all.push_back(text_of(name, "a list of texts", entry));
  return all;
}

std::vector<int> Arguments::integers(const char* name) const {
  std::vector<int> all;
  for (const auto& entry : entries_of(name, "a list of integers", value(name)))
    all.push_back(integer_of(name, "a list of integers", entry));
  return all;
}

}  // namespace sandglass
