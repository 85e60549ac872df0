#include "device/opencl.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"

namespace sandglass {

namespace {

/// The address of a function of the library, converted to the type of the pointer that takes it.
struct Symbol {
  void* address;
  template <class Function>
  operator Function*() const {
    return reinterpret_cast<Function*>(address);
  }
};

/// The functions that are used here; all null without the library.
struct OpenCl {
  void* library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);

  Symbol find(const char* name) const { return {library == nullptr ? nullptr : dlsym(library, name)}; }

  decltype(&clGetPlatformIDs) get_platforms = find("clGetPlatformIDs");
  decltype(&clGetDeviceIDs) get_devices = find("clGetDeviceIDs");
  decltype(&clGetDeviceInfo) get_device_info = find("clGetDeviceInfo");
  decltype(&clCreateContext) create_context = find("clCreateContext");
  decltype(&clReleaseContext) release_context = find("clReleaseContext");
  decltype(&clCreateCommandQueue) create_queue = find("clCreateCommandQueue");
  decltype(&clReleaseCommandQueue) release_queue = find("clReleaseCommandQueue");
  decltype(&clCreateBuffer) create_buffer = find("clCreateBuffer");
  decltype(&clReleaseMemObject) release_buffer = find("clReleaseMemObject");
  decltype(&clEnqueueWriteBuffer) write = find("clEnqueueWriteBuffer");
  decltype(&clEnqueueReadBuffer) read = find("clEnqueueReadBuffer");
  decltype(&clCreateProgramWithSource) create_program = find("clCreateProgramWithSource");
  decltype(&clBuildProgram) build = find("clBuildProgram");
  decltype(&clGetProgramBuildInfo) get_build_info = find("clGetProgramBuildInfo");
  decltype(&clReleaseProgram) release_program = find("clReleaseProgram");
  decltype(&clCreateKernel) create_kernel = find("clCreateKernel");
  decltype(&clReleaseKernel) release_kernel = find("clReleaseKernel");
  decltype(&clSetKernelArg) set_argument = find("clSetKernelArg");
  decltype(&clEnqueueNDRangeKernel) run = find("clEnqueueNDRangeKernel");
};

const OpenCl& opencl() {
  static const OpenCl functions;
  return functions;
}

void require_success(cl_int code, const std::string& device, std::string_view action) {
  if (code == CL_SUCCESS) return;
  throw ComputationError(
      fmt::format("OpenCL device '{}': {} failed with error {} of OpenCL; allowed: another "
                  "device, or none (leave out --device)",
                  device, action, code));
}

std::string text_of(cl_device_id device, cl_device_info key) {
  std::size_t size = 0;
  opencl().get_device_info(device, key, 0, nullptr, &size);
  std::string text(size, '\0');
  opencl().get_device_info(device, key, size, text.data(), nullptr);
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

cl_ulong number_of(cl_device_id device, cl_device_info key) {
  cl_ulong number = 0;
  opencl().get_device_info(device, key, sizeof number, &number, nullptr);
  return number;
}

/// The handles that a query lists; none if it fails, as it does where there are none.
template <class Handle, class Query>
std::vector<Handle> listed(const Query& query) {
  cl_uint count = 0;
  if (query(0, nullptr, &count) != CL_SUCCESS) return {};
  std::vector<Handle> handles(count);
  if (query(count, handles.data(), nullptr) != CL_SUCCESS) return {};
  return handles;
}

}  // namespace

std::vector<OpenClDeviceName> opencl_devices() {
  std::vector<OpenClDeviceName> found;
  if (opencl().get_platforms == nullptr) return found;
  const auto platforms = listed<cl_platform_id>(opencl().get_platforms);
  for (const bool graphics : {true, false}) {
    for (cl_platform_id platform : platforms) {
      const auto devices = listed<cl_device_id>([&](cl_uint most, cl_device_id* ids, cl_uint* count) {
        return opencl().get_devices(platform, CL_DEVICE_TYPE_ALL, most, ids, count);
      });
      for (cl_device_id device : devices) {
        const bool is_graphics = (number_of(device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU) != 0;
        if (is_graphics != graphics) continue;
        found.push_back({text_of(device, CL_DEVICE_NAME), number_of(device, CL_DEVICE_DOUBLE_FP_CONFIG) != 0,
                         number_of(device, CL_DEVICE_MAX_WORK_GROUP_SIZE), platform, device});
      }
    }
  }
  return found;
}

void OpenClDevice::Release::operator()(cl_context context) const {
  opencl().release_context(context);
}
void OpenClDevice::Release::operator()(cl_command_queue queue) const {
  opencl().release_queue(queue);
}
void OpenClBuffer::Release::operator()(cl_mem memory) const {
  opencl().release_buffer(memory);
}
void OpenClKernel::Release::operator()(cl_program program) const {
  opencl().release_program(program);
}
void OpenClKernel::Release::operator()(cl_kernel kernel) const {
  opencl().release_kernel(kernel);
}

OpenClDevice::OpenClDevice(const OpenClDeviceName& chosen) : name_(chosen.name), device_(chosen.device) {
  const std::array<cl_context_properties, 3> properties{
      CL_CONTEXT_PLATFORM, reinterpret_cast<cl_context_properties>(chosen.platform), 0};
  cl_int code = CL_SUCCESS;
  context_.reset(opencl().create_context(properties.data(), 1, &device_, nullptr, nullptr, &code));
  require_success(code, name_, "opening it");
  queue_.reset(opencl().create_queue(context_.get(), device_, 0, &code));
  require_success(code, name_, "opening it");
}

void OpenClDevice::require_room(std::span<const std::size_t> bytes) const {
  const std::size_t all = std::reduce(bytes.begin(), bytes.end()), largest = std::ranges::max(bytes);
  const std::size_t room = number_of(device_, CL_DEVICE_GLOBAL_MEM_SIZE),
                    of_one = number_of(device_, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  if (all <= room && largest <= of_one) return;
  throw InputError(
      fmt::format("device: '{}' has {:.3g} GB of memory, at most {:.3g} GB in one piece; "
                  "this needs {:.3g} GB, {:.3g} GB in one piece; allowed: a smaller mesh, "
                  "single precision, or another device",
                  name_, 1e-9 * static_cast<double>(room), 1e-9 * static_cast<double>(of_one),
                  1e-9 * static_cast<double>(all), 1e-9 * static_cast<double>(largest)));
}

OpenClBuffer::OpenClBuffer(const OpenClDevice& device, std::size_t bytes) : device_(device) {
  cl_int code = CL_SUCCESS;
  memory_.reset(opencl().create_buffer(device.context_.get(), CL_MEM_READ_WRITE,
                                       std::max<std::size_t>(bytes, 1), nullptr, &code));
  require_success(code, device.name(), "taking memory");
}

void OpenClBuffer::write(const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  require_success(
      opencl().write(device_.queue_.get(), memory_.get(), CL_TRUE, 0, bytes, from, 0, nullptr, nullptr),
      device_.name(), "copying to it");
}

void OpenClBuffer::read(void* to, std::size_t bytes) const {
  if (bytes == 0) return;
  require_success(
      opencl().read(device_.queue_.get(), memory_.get(), CL_TRUE, 0, bytes, to, 0, nullptr, nullptr),
      device_.name(), "copying from it");
}

OpenClKernel::OpenClKernel(const OpenClDevice& device, const std::string& source, const std::string& name)
    : device_(device) {
  const char* text = source.c_str();
  cl_int code = CL_SUCCESS;
  program_.reset(opencl().create_program(device.context_.get(), 1, &text, nullptr, &code));
  require_success(code, device.name(), "compiling a kernel");
  // Divisions and roots of single precision are rounded as those of the program are.
  const char* options = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";
  if (opencl().build(program_.get(), 1, &device.device_, options, nullptr, nullptr) != CL_SUCCESS &&
      opencl().build(program_.get(), 1, &device.device_, "", nullptr, nullptr) != CL_SUCCESS) {
    std::string messages(4000, '\0');
    opencl().get_build_info(program_.get(), device.device_, CL_PROGRAM_BUILD_LOG, messages.size() - 1,
                            messages.data(), nullptr);
    throw ComputationError(fmt::format("OpenCL device '{}': compiling kernel '{}' failed:\n{}", device.name(),
                                       name, messages.c_str()));
  }
  kernel_.reset(opencl().create_kernel(program_.get(), name.c_str(), &code));
  require_success(code, device.name(), "compiling a kernel");
}

void OpenClKernel::set_argument(cl_uint index, const OpenClBuffer& buffer) {
  const cl_mem memory = buffer.memory_.get();
  set_bytes(index, sizeof(cl_mem), &memory);
}

void OpenClKernel::set_bytes(cl_uint index, std::size_t size, const void* bytes) {
  require_success(opencl().set_argument(kernel_.get(), index, size, bytes), device_.name(),
                  "setting an argument");
}

void OpenClKernel::run(std::size_t first, std::size_t count) const {
  require_success(
      opencl().run(device_.queue_.get(), kernel_.get(), 1, &first, &count, &group, 0, nullptr, nullptr),
      device_.name(), "starting a kernel");
}

}  // namespace sandglass
