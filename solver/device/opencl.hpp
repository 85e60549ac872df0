#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// OpenCL 1.2. Its library is loaded at run time, when devices are first listed.
namespace sandglass {

/// A device that OpenCL lists.
struct OpenClDeviceName {
  std::string name;
  bool has_double;
  std::size_t largest_group;  ///< of work items
  cl_platform_id platform;
  cl_device_id device;
};

/// All devices, graphics cards first. Empty without the library.
std::vector<OpenClDeviceName> opencl_devices();

/// An open device with a queue that works in order.
class OpenClDevice {
 public:
  /// Throws ComputationError if the device cannot be opened.
  explicit OpenClDevice(const OpenClDeviceName& chosen);

  const std::string& name() const { return name_; }

  /// Throws InputError if the device cannot keep buffers of so many bytes at the same time.
  void require_room(std::span<const std::size_t> bytes) const;

 private:
  friend class OpenClBuffer;
  friend class OpenClKernel;

  struct Release {
    void operator()(cl_context context) const;
    void operator()(cl_command_queue queue) const;
  };
  template <class Handle>
  using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

  std::string name_;
  cl_device_id device_;
  Owned<cl_context> context_;
  Owned<cl_command_queue> queue_;
};

/// Memory of a device. Copies to and from it wait for the work that was queued before.
class OpenClBuffer {
 public:
  OpenClBuffer(const OpenClDevice& device, std::size_t bytes);

  /// Memory with the contents of an array.
  template <class T>
  OpenClBuffer(const OpenClDevice& device, const std::vector<T>& values)
      : OpenClBuffer(device, values.size() * sizeof(T)) {
    write(values.data(), values.size() * sizeof(T));
  }

  void write(const void* from, std::size_t bytes);
  void read(void* to, std::size_t bytes) const;

 private:
  friend class OpenClKernel;

  struct Release {
    void operator()(cl_mem memory) const;
  };

  const OpenClDevice& device_;
  std::unique_ptr<std::remove_pointer_t<cl_mem>, Release> memory_;
};

/// A function of a program, with its arguments.
class OpenClKernel {
 public:
  /// Compiles a source for a device. Throws ComputationError with the compiler's messages if that fails.
  OpenClKernel(const OpenClDevice& device, const std::string& source, const std::string& name);

  /// Sets all arguments: buffers and numbers.
  template <class... Arguments>
  void set(const Arguments&... arguments) {
    cl_uint next = 0;
    (set_argument(next++, arguments), ...);
  }

  /// Sets one argument.
  void set_argument(cl_uint index, const OpenClBuffer& buffer);
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void set_argument(cl_uint index, Number number) { set_bytes(index, sizeof number, &number); }

  /// Queues a call for each of `count` numbers from `first` on, both multiples of `group`.
  void run(std::size_t first, std::size_t count) const;

  /// Work items that run side by side.
  static constexpr std::size_t group = 64;

 private:
  struct Release {
    void operator()(cl_program program) const;
    void operator()(cl_kernel kernel) const;
  };

  void set_bytes(cl_uint index, std::size_t size, const void* bytes);

  const OpenClDevice& device_;
  std::unique_ptr<std::remove_pointer_t<cl_program>, Release> program_;
  std::unique_ptr<std::remove_pointer_t<cl_kernel>, Release> kernel_;
};

}  // namespace sandglass
