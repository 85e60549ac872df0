#include "written/shared_program.hpp"

#include <algorithm>
#include <utility>

namespace sandglass {

namespace {

std::vector<Constant> constants_of(const Program& program) {
  std::vector<Constant> constants;
  for (const Step& step : program.steps) {
    if (step.operation == Operation::constant) constants.push_back(step.value);
  }
  return constants;
}

bool same_steps(const ForceProgram& one, const ForceProgram& other) {
  const auto same_array = [](const KernelArray& a, const KernelArray& b) {
    return a.name == b.name && a.numbers == b.numbers;
  };
  const auto same_step = [](const Step& a, const Step& b) {
    return a.operation == b.operation && a.of == b.of;
  };
  return one.program.results == other.program.results &&
         std::ranges::equal(one.arrays, other.arrays, same_array) &&
         std::ranges::equal(one.program.steps, other.program.steps, same_step);
}

}  // namespace

SharedProgram::SharedProgram(ForceProgram first)
    : first_(std::move(first)), constants_{constants_of(first_.program)} {}

bool SharedProgram::add(const ForceProgram& other) {
  if (!same_steps(first_, other)) return false;
  constants_.push_back(constants_of(other.program));
  return true;
}

std::vector<std::size_t> SharedProgram::differing() const {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < constants_.front().size(); ++k) {
    const Constant& first = constants_.front()[k];
    const auto is_same = [&](const std::vector<Constant>& one) { return one[k] == first; };
    if (!std::ranges::all_of(constants_, is_same)) places.push_back(k);
  }
  return places;
}

ForceProgram SharedProgram::program() const {
  ForceProgram shared = first_;
  const std::vector<std::size_t> places = differing();
  if (places.empty()) return shared;
  int input = 0;
  for (const KernelArray& array : shared.arrays) input += array.numbers;
  std::size_t constant = 0;
  auto next = places.begin();
  for (Step& step : shared.program.steps) {
    if (step.operation != Operation::constant) continue;
    if (next != places.end() && *next == constant) {
      step = {Operation::input, {input++, -1, -1}, {}};
      ++next;
    }
    ++constant;
  }
  shared.arrays.push_back({"parameters", static_cast<int>(places.size()), "of the element's law"});
  return shared;
}

std::vector<std::vector<Constant>> SharedProgram::parameters() const {
  const std::vector<std::size_t> places = differing();
  std::vector<std::vector<Constant>> parameters(constants_.size());
  for (std::size_t n = 0; n < constants_.size(); ++n) {
    for (const std::size_t k : places) parameters[n].push_back(constants_[n][k]);
  }
  return parameters;
}

}  // namespace sandglass
