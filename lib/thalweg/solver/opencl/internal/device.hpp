// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace thalweg::solver {

/// The chosen device, ready for use: created on first use, kept for the life of the process. Handles are OpenCL's own
/// pointers.
struct OpenClDevice {
    void* device = nullptr;
    void* context = nullptr;
    std::string name;
    std::int64_t memory_bytes = 0;        ///< of the device
    std::int64_t largest_block_bytes = 0; ///< largest single allocation
};

/// Returns the device of opencl_device_name().
/// \throws BadParameter as opencl_device_name()
OpenClDevice const& opencl_device();

/// The name of an OpenCL error code: "CL_OUT_OF_RESOURCES".
std::string opencl_error_name(int code);

/// Checks that blocks fit into the device's memory.
/// \param stage for messages
/// \param bytes of all blocks
/// \param largest_bytes of the largest block
/// \throws IoError with both numbers when they do not fit
void check_device_memory(OpenClDevice const& device, char const* stage, std::int64_t bytes, std::int64_t largest_bytes);

/// An array in the memory of the OpenCL device; copies share it, the last one frees it.
template <class T> class DeviceArray {
public:
    DeviceArray() = default;
    DeviceArray(std::shared_ptr<void> memory, std::int64_t count) : memory_(std::move(memory)), count_(count) {}
    void* handle() const { return memory_.get(); }
    std::int64_t size() const { return count_; }

private:
    std::shared_ptr<void> memory_;
    std::int64_t count_ = 0;
};

/// Compiled kernels and an in-order queue of work on the OpenCL device. Use one object per thread. Every call throws
/// IoError with OpenCL's message when the device fails.
class DeviceQueue {
public:
    /// Work items that share local memory; every kernel runs in whole groups along its first axis.
    static constexpr std::size_t group = 64;

    /// Compiles kernels, once in the life of the process.
    /// \param stage for messages
    /// \param source OpenCL C 1.2
    /// \throws BadParameter as opencl_device()
    /// \throws IoError with the compiler's message
    DeviceQueue(char const* stage, std::string_view source);

    OpenClDevice const& device() const { return *device_; }

    /// Makes an array of zeros.
    template <class T> DeviceArray<T> zeros(std::int64_t count) {
        return {take(count * static_cast<std::int64_t>(sizeof(T))), count};
    }
    /// Copies values to the device, with `margin` zeros before and after.
    template <class T> DeviceArray<T> copy_of(std::span<T const> values, std::int64_t margin = 0) {
        auto array = zeros<T>(static_cast<std::int64_t>(values.size()) + 2 * margin);
        write(array.handle(), static_cast<std::size_t>(margin) * sizeof(T), values.data(), values.size_bytes());
        return array;
    }
    /// Copies an array, without its margin, to the host, after all queued work.
    template <class T> void read(DeviceArray<T> const& from, std::span<T> to, std::int64_t margin = 0) {
        read(from.handle(), static_cast<std::size_t>(margin) * sizeof(T), to.data(), to.size_bytes());
    }

    /// Queues a kernel for columns x rows work items (columns is rounded up to whole groups), with arrays and numbers
    /// in the order of the kernel's parameters.
    template <class... Arguments>
    void run(char const* kernel, std::int64_t columns, std::int64_t rows, Arguments const&... arguments) {
        void* const k = kernel_of(kernel);
        unsigned at = 0;
        (set(k, at++, arguments), ...);
        start(k, kernel, columns, rows);
    }
    /// Waits until all work is done.
    void finish();

private:
    std::shared_ptr<void> take(std::int64_t bytes);
    void write(void* to, std::size_t at, void const* from, std::size_t bytes);
    void read(void* from, std::size_t at, void* to, std::size_t bytes);
    void* kernel_of(char const* name);
    void set(void* kernel, unsigned at, std::size_t bytes, void const* value);
    template <class T> void set(void* kernel, unsigned at, DeviceArray<T> const& array) {
        void* const handle = array.handle();
        set(kernel, at, sizeof handle, static_cast<void const*>(&handle));
    }
    template <class T>
        requires std::is_arithmetic_v<T>
    void set(void* kernel, unsigned at, T value) {
        set(kernel, at, sizeof value, static_cast<void const*>(&value));
    }
    void start(void* kernel, char const* name, std::int64_t columns, std::int64_t rows);
    void check(int code, std::string_view what) const;

    std::string stage_;
    OpenClDevice const* device_;
    void* program_;
    std::shared_ptr<void> queue_;
    std::map<std::string, std::shared_ptr<void>, std::less<>> kernels_;
};

} // namespace thalweg::solver
