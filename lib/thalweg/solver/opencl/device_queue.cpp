// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/device_queue.hpp>

#include <array>
#include <mutex>
#include <utility>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::solver {

namespace {

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
        throw IoError(fmt::format("{}: the OpenCL device {} does not compile the kernels: {}; leave --device out\n{}",
                                  stage, device.name, opencl_error_name(code), log));
    }
    return program;
}

/// Compiled once: drivers take from milliseconds to seconds for it.
cl_program program_of(OpenClDevice const& device, std::string const& stage, std::string_view source) {
    static std::mutex one_at_a_time;
    static auto& built = *new std::map<std::pair<void*, std::string>, cl_program>; // kept, as the devices are
    std::scoped_lock const lock(one_at_a_time);
    std::pair const key{device.device, std::string(source)};
    auto at = built.find(key);
    if (at == built.end()) {
        at = built.emplace(key, build(device, stage, source)).first;
    }
    return at->second;
}

} // namespace

DeviceQueue::DeviceQueue(char const* stage, std::string_view source)
    : stage_(stage), device_(&opencl_device()), program_(program_of(*device_, stage_, source)) {
    cl_int code = CL_SUCCESS;
    cl_command_queue const queue = clCreateCommandQueue(static_cast<cl_context>(device_->context),
                                                        static_cast<cl_device_id>(device_->device), 0, &code);
    check(code, "making a queue");
    queue_ = {queue, [](void* q) {
                  clFinish(static_cast<cl_command_queue>(q)); // the host's memory of a copy may end next
                  clReleaseCommandQueue(static_cast<cl_command_queue>(q));
              }};
}

void DeviceQueue::check(int code, std::string_view what) const {
    if (code != CL_SUCCESS) {
        throw IoError(fmt::format("{}: the OpenCL device {} failed at {}: {}; leave --device out", stage_,
                                  device_->name, what, opencl_error_name(code)));
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
