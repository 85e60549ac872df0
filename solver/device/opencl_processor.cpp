#include "device/opencl_processor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <numeric>

#include "assembly/processor.hpp"
#include "base/error.hpp"
#include "device/opencl_force.hpp"
#include "written/force_program.hpp"

namespace sandglass {

namespace {

constexpr std::string_view prefix = "opencl";

class OpenClProcessor final : public Processor {
 public:
  explicit OpenClProcessor(const OpenClDeviceName& chosen)
      : chosen_(chosen), device_(std::make_shared<const OpenClDevice>(chosen)) {}

  std::string name() const override { return chosen_.name; }

  std::string refusal(const Materials& materials, const MethodChoice& choice) const override {
    if (const auto reason = why_not_written(choice.method); !reason.empty()) {
      return fmt::format("method '{}' runs on this processor alone: {}", choice.method, reason);
    }
    for (const Material& material : materials.list) {
      if (!is_viscoelastic(material.law)) continue;
      return fmt::format("law '{}' runs on this processor alone: its elements remember earlier steps",
                         name_of(material.law));
    }
    if (choice.ranks->count() > 1) return "a device computes whole bodies; leave out mpirun";
    if (choice.precision == Precision::double_precision && !chosen_.has_double) {
      return fmt::format("'{}' does not compute in double precision", chosen_.name);
    }
    if (chosen_.largest_group < OpenClKernel::group) {
      return fmt::format("'{}' runs groups of at most {} work items, not {}", chosen_.name,
                         chosen_.largest_group, OpenClKernel::group);
    }
    return {};
  }

  std::unique_ptr<InternalForce<double>> forces(std::unique_ptr<InternalForce<double>> own, const Mesh& mesh,
                                                const Materials& materials,
                                                const MethodChoice& choice) const override {
    return made(std::move(own), mesh, materials, choice);
  }
  std::unique_ptr<InternalForce<float>> forces(std::unique_ptr<InternalForce<float>> own, const Mesh& mesh,
                                               const Materials& materials,
                                               const MethodChoice& choice) const override {
    return made(std::move(own), mesh, materials, choice);
  }

 private:
  template <class Real>
  std::unique_ptr<InternalForce<Real>> made(std::unique_ptr<InternalForce<Real>> own, const Mesh& mesh,
                                            const Materials& materials, const MethodChoice& choice) const {
    if (const auto reason = refusal(materials, choice); !reason.empty()) {
      throw InputError(
          fmt::format("device: {}; allowed: elastic laws, methods such as tl-mean-dilatation, and "
                      "the precisions of the device; or the device cpu",
                      reason));
    }
    return std::make_unique<OpenClForce<Real>>(device_, std::move(own), mesh, materials, choice);
  }

  OpenClDeviceName chosen_;
  std::shared_ptr<const OpenClDevice> device_;
};

/// "opencl:1 (pthread-Xeon)".
std::string described(const std::vector<OpenClDeviceName>& devices) {
  std::vector<std::string> each{"cpu"};
  for (std::size_t n = 0; n < devices.size(); ++n) {
    each.push_back(fmt::format("{}:{} ({})", prefix, n + 1, devices[n].name));
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

}  // namespace

std::shared_ptr<const Processor> processor_named(const std::string& name, std::string_view key) {
  if (name == "cpu") return nullptr;
  const auto devices = opencl_devices();
  std::size_t number = 0;
  if (name == prefix) {
    number = 1;
  } else if (name.starts_with(fmt::format("{}:", prefix))) {
    const char *first = name.data() + prefix.size() + 1, *last = name.data() + name.size();
    if (const auto [end, error] = std::from_chars(first, last, number); error != std::errc() || end != last)
      number = 0;
  }
  if (number >= 1 && number <= devices.size())
    return std::make_shared<const OpenClProcessor>(devices[number - 1]);
  throw InputError(fmt::format(
      "{} = '{}' is no processor of this machine{}; allowed: {}", key, name,
      devices.empty() ? " (OpenCL finds none; a driver is missing, such as pocl-opencl-icd for processors)"
                      : "",
      described(devices)));
}

}  // namespace sandglass
