// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/device.hpp>

#include <array>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <vector>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/opencl/devices.hpp>

namespace thalweg::solver {
namespace {

constexpr char const* variable = "THALWEG_OPENCL_DEVICE";

struct FoundDevice {
    cl_device_id id = nullptr;
    cl_platform_id platform = nullptr;
    std::string number; ///< "0:0"
    std::string name;
    std::string platform_name;
    cl_device_type type = 0;
    std::string fault; ///< why it cannot be used; "": it can
};

template <class T> T number_of(cl_device_id id, cl_device_info what) {
    T value{};
    clGetDeviceInfo(id, what, sizeof value, &value, nullptr);
    return value;
}

template <class Ask> std::string text_of(Ask ask) {
    std::size_t size = 0;
    ask(std::size_t{0}, nullptr, &size);
    std::string text(size, '\0');
    ask(size, text.data(), nullptr);
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) {
        text.pop_back();
    }
    return text;
}

std::string fault_of(cl_device_id id) {
    if (number_of<cl_bool>(id, CL_DEVICE_AVAILABLE) == CL_FALSE) {
        return "it is not available";
    }
    if (number_of<cl_bool>(id, CL_DEVICE_COMPILER_AVAILABLE) == CL_FALSE) {
        return "its driver has no compiler";
    }
    if (number_of<cl_device_fp_config>(id, CL_DEVICE_DOUBLE_FP_CONFIG) == 0) {
        return "it has no 64-bit floating point (fp64)";
    }
    if (number_of<std::size_t>(id, CL_DEVICE_MAX_WORK_GROUP_SIZE) < DeviceQueue::group) {
        return fmt::format("its work groups are smaller than {}", DeviceQueue::group);
    }
    return "";
}

/// A missing platform is not an error: the list is then empty.
std::vector<FoundDevice> find_devices() {
    // PoCL on a processor: its other method for work groups crashes in version 6.0; results are the same.
    setenv("POCL_WORK_GROUP_METHOD", "cbs", 0);
    cl_uint platform_count = 0;
    if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS || platform_count == 0) {
        return {};
    }
    std::vector<cl_platform_id> platforms(platform_count);
    clGetPlatformIDs(platform_count, platforms.data(), nullptr);
    std::vector<FoundDevice> all;
    for (std::size_t p = 0; p < platforms.size(); ++p) {
        std::string const platform_name = text_of([&](std::size_t size, char* text, std::size_t* needed) {
            clGetPlatformInfo(platforms[p], CL_PLATFORM_NAME, size, text, needed);
        });
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) {
            continue;
        }
        std::vector<cl_device_id> ids(count);
        clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr);
        for (std::size_t d = 0; d < ids.size(); ++d) {
            FoundDevice found;
            found.id = ids[d];
            found.platform = platforms[p];
            found.number = fmt::format("{}:{}", p, d);
            found.name = text_of([&](std::size_t size, char* text, std::size_t* needed) {
                clGetDeviceInfo(ids[d], CL_DEVICE_NAME, size, text, needed);
            });
            found.platform_name = platform_name;
            found.type = number_of<cl_device_type>(ids[d], CL_DEVICE_TYPE);
            found.fault = fault_of(ids[d]);
            all.push_back(std::move(found));
        }
    }
    return all;
}

std::string line_of(FoundDevice const& found) {
    return fmt::format("{} {} ({}){}", found.number, found.name, found.platform_name,
                       found.fault.empty() ? "" : ": " + found.fault);
}

std::string lines_of(std::vector<FoundDevice> const& all) {
    std::string text;
    for (FoundDevice const& found : all) {
        text += (text.empty() ? "" : "; ") + line_of(found);
    }
    return text;
}

FoundDevice choose(std::vector<FoundDevice> const& all) {
    refuse_if<BadParameter>(all.empty(), "solver.opencl_device",
                            "--device opencl: no OpenCL platform with a device was found; install an OpenCL driver "
                            "(Debian: pocl-opencl-icd) or leave --device out");
    if (char const* const wanted = std::getenv(variable); wanted != nullptr) {
        for (FoundDevice const& found : all) {
            if (found.number != wanted) {
                continue;
            }
            refuse_if<BadParameter>(!found.fault.empty(), "solver.opencl_device",
                                    "--device opencl: {}={}, {}, cannot be used: {}", variable, wanted, found.name,
                                    found.fault);
            return found;
        }
        throw BadParameter("solver.opencl_device",
                           fmt::format("--device opencl: {}='{}' names no device: write platform:device as in {}",
                                       variable, wanted, lines_of(all)));
    }
    for (cl_device_type const type : {cl_device_type{CL_DEVICE_TYPE_GPU}, cl_device_type{CL_DEVICE_TYPE_ACCELERATOR},
                                      cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_ALL}}) {
        for (FoundDevice const& found : all) {
            if (found.fault.empty() && (found.type & type) != 0) {
                return found;
            }
        }
    }
    throw BadParameter("solver.opencl_device",
                       fmt::format("--device opencl: no device can be used: {}; leave --device out", lines_of(all)));
}

std::string build_log(cl_program program, cl_device_id device) {
    std::size_t size = 0;
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) {
        log.pop_back();
    }
    return log;
}

cl_program build(OpenClDevice const& device, std::string const& stage, std::string_view source) {
    char const* text = source.data();
    std::size_t const length = source.size();
    auto const id = static_cast<cl_device_id>(device.device);
    cl_int code = CL_SUCCESS;
    cl_program const program =
        clCreateProgramWithSource(static_cast<cl_context>(device.context), 1, &text, &length, &code);
    if (code == CL_SUCCESS) {
        code = clBuildProgram(program, 1, &id, "-cl-std=CL1.2", nullptr, nullptr);
    }
    if (code != CL_SUCCESS) {
        std::string const log = program == nullptr ? "" : build_log(program, id);
        clReleaseProgram(program);
        throw IoError(stage,
                      fmt::format("the OpenCL device {} does not compile the kernels: {}; leave --device out\n{}",
                                  device.name, opencl_error_name(code), log));
    }
    return program;
}

/// Compiled once: it takes a driver from milliseconds to seconds.
cl_program program_of(OpenClDevice const& device, std::string const& stage, std::string_view source) {
    static std::mutex one_at_a_time;
    static auto& built = *new std::map<std::pair<void*, std::string>, cl_program>; // never freed, like the devices
    std::scoped_lock const lock(one_at_a_time);
    std::pair const key{device.device, std::string(source)};
    auto at = built.find(key);
    if (at == built.end()) {
        at = built.emplace(key, build(device, stage, source)).first;
    }
    return at->second;
}

} // namespace

std::vector<std::string> opencl_devices() {
    std::vector<std::string> lines;
    for (FoundDevice const& found : find_devices()) {
        lines.push_back(line_of(found));
    }
    return lines;
}

std::string opencl_device_name() {
    return choose(find_devices()).name;
}

OpenClDevice const& opencl_device() {
    static std::mutex one_at_a_time;
    // Never freed: the driver may be unloaded before static destructors run.
    static auto& ready = *new std::map<cl_device_id, OpenClDevice>;
    FoundDevice const found = choose(find_devices());
    std::scoped_lock const lock(one_at_a_time);
    if (auto const at = ready.find(found.id); at != ready.end()) {
        return at->second;
    }
    std::array<cl_context_properties, 3> const properties{CL_CONTEXT_PLATFORM,
                                                          reinterpret_cast<cl_context_properties>(found.platform), 0};
    cl_int code = CL_SUCCESS;
    cl_context const context = clCreateContext(properties.data(), 1, &found.id, nullptr, nullptr, &code);
    if (code != CL_SUCCESS) {
        throw IoError("solver.opencl_device",
                      fmt::format("--device opencl: {} cannot create a context: {}; leave --device out", found.name,
                                  opencl_error_name(code)));
    }
    OpenClDevice device;
    device.device = found.id;
    device.context = context;
    device.name = found.name;
    device.memory_bytes = static_cast<std::int64_t>(number_of<cl_ulong>(found.id, CL_DEVICE_GLOBAL_MEM_SIZE));
    device.largest_block_bytes = static_cast<std::int64_t>(number_of<cl_ulong>(found.id, CL_DEVICE_MAX_MEM_ALLOC_SIZE));
    return ready.emplace(found.id, std::move(device)).first->second;
}

std::string opencl_error_name(int code) {
    constexpr std::array<std::pair<int, char const*>, 12> names{{
        {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE"},
        {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
        {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES"},
        {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY"},
        {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE"},
        {CL_INVALID_VALUE, "CL_INVALID_VALUE"},
        {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE"},
        {CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME"},
        {CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS"},
        {CL_INVALID_ARG_SIZE, "CL_INVALID_ARG_SIZE"},
        {CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE"},
        {CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT"},
    }};
    for (auto const& [number, name] : names) {
        if (number == code) {
            return name;
        }
    }
    return fmt::format("OpenCL's error {}", code);
}

void check_device_memory(OpenClDevice const& device, char const* stage, std::int64_t bytes,
                         std::int64_t largest_bytes) {
    if (bytes <= device.memory_bytes && largest_bytes <= device.largest_block_bytes) {
        return;
    }
    auto const gigabytes = [](std::int64_t b) { return static_cast<double>(b) / 1e9; };
    throw IoError(stage,
                  fmt::format("the grid needs {:.1f} GB in blocks of up to {:.1f} GB on the OpenCL device {}, which "
                              "has {:.1f} GB in blocks of up to {:.1f} GB: make the grid smaller or leave --device out",
                              gigabytes(bytes), gigabytes(largest_bytes), device.name, gigabytes(device.memory_bytes),
                              gigabytes(device.largest_block_bytes)));
}

DeviceQueue::DeviceQueue(char const* stage, std::string_view source)
    : stage_(stage), device_(&opencl_device()), program_(program_of(*device_, stage_, source)) {
    cl_int code = CL_SUCCESS;
    cl_command_queue const queue = clCreateCommandQueue(static_cast<cl_context>(device_->context),
                                                        static_cast<cl_device_id>(device_->device), 0, &code);
    check(code, "making a queue");
    queue_ = {queue, [](void* q) {
                  clFinish(static_cast<cl_command_queue>(q)); // the host memory of a copy may be freed next
                  clReleaseCommandQueue(static_cast<cl_command_queue>(q));
              }};
}

void DeviceQueue::check(int code, std::string_view what) const {
    if (code != CL_SUCCESS) {
        throw IoError(stage_, fmt::format("the OpenCL device {} failed at {}: {}; leave --device out", device_->name,
                                          what, opencl_error_name(code)));
    }
}

std::shared_ptr<void> DeviceQueue::take(std::int64_t bytes) {
    auto const size = static_cast<std::size_t>(bytes);
    std::string const what = fmt::format("taking {} bytes", bytes);
    cl_int code = CL_SUCCESS;
    cl_mem const memory =
        clCreateBuffer(static_cast<cl_context>(device_->context), CL_MEM_READ_WRITE, size, nullptr, &code);
    check(code, what);
    std::shared_ptr<void> kept(memory, [](void* m) { clReleaseMemObject(static_cast<cl_mem>(m)); });
    cl_uchar const zero = 0;
    check(clEnqueueFillBuffer(static_cast<cl_command_queue>(queue_.get()), memory, &zero, sizeof zero, 0, size, 0,
                              nullptr, nullptr),
          what);
    return kept;
}

void DeviceQueue::write(void* to, std::size_t at, void const* from, std::size_t bytes) {
    check(clEnqueueWriteBuffer(static_cast<cl_command_queue>(queue_.get()), static_cast<cl_mem>(to), CL_TRUE, at, bytes,
                               from, 0, nullptr, nullptr),
          "copying to it");
}

void DeviceQueue::read(void* from, std::size_t at, void* to, std::size_t bytes) {
    check(clEnqueueReadBuffer(static_cast<cl_command_queue>(queue_.get()), static_cast<cl_mem>(from), CL_TRUE, at,
                              bytes, to, 0, nullptr, nullptr),
          "copying from it");
}

void* DeviceQueue::kernel_of(char const* name) {
    auto at = kernels_.find(name);
    if (at == kernels_.end()) {
        cl_int code = CL_SUCCESS;
        cl_kernel const kernel = clCreateKernel(static_cast<cl_program>(program_), name, &code);
        check(code, name);
        at = kernels_
                 .emplace(name,
                          std::shared_ptr<void>(kernel, [](void* k) { clReleaseKernel(static_cast<cl_kernel>(k)); }))
                 .first;
    }
    return at->second.get();
}

void DeviceQueue::set(void* kernel, unsigned at, std::size_t bytes, void const* value) {
    check(clSetKernelArg(static_cast<cl_kernel>(kernel), at, bytes, value), "setting a parameter");
}

void DeviceQueue::start(void* kernel, char const* name, std::int64_t columns, std::int64_t rows) {
    std::size_t const wide = (static_cast<std::size_t>(columns) + group - 1) / group * group;
    std::array<std::size_t, 2> const global{wide, static_cast<std::size_t>(rows)};
    std::array<std::size_t, 2> const local{group, 1};
    check(clEnqueueNDRangeKernel(static_cast<cl_command_queue>(queue_.get()), static_cast<cl_kernel>(kernel), 2,
                                 nullptr, global.data(), local.data(), 0, nullptr, nullptr),
          name);
}

void DeviceQueue::finish() {
    check(clFinish(static_cast<cl_command_queue>(queue_.get())), "finishing");
}

} // namespace thalweg::solver
