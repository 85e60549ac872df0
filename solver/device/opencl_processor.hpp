#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace sandglass {

class Processor;

/// The processor that a user names: "opencl" for the first device of OpenCL, graphics cards first, or
/// "opencl:2" for the second. Null for "cpu". Throws InputError, which lists the devices of this machine, for
/// anything else; the error names `key`.
std::shared_ptr<const Processor> processor_named(const std::string& name, std::string_view key = "--device");

}  // namespace sandglass
