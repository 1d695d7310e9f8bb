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

/// The chosen device, ready for work: one for the life of the process, made when it is first asked for. A handle is
/// OpenCL's own pointer.
struct OpenClDevice {
    void* device = nullptr;
    void* context = nullptr;
    std::string name;
    std::int64_t memory_bytes = 0;        ///< of the device
    std::int64_t largest_block_bytes = 0; ///< that can be taken at once
};

/// Throws: as opencl_device_name().
OpenClDevice const& opencl_device();

/// What OpenCL's numbers mean: "CL_OUT_OF_RESOURCES".
std::string opencl_error_name(int code);

/// Throws: IoError with both numbers when blocks of these sizes do not fit into the device's memory.
/// Takes: the stage that asks, for the message; bytes of all blocks and of the largest.
void check_device_memory(OpenClDevice const& device, char const* stage, std::int64_t bytes, std::int64_t largest_bytes);

/// A block of numbers in the memory of the OpenCL device; copies share it, the last one frees it.
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

/// Kernels compiled for the OpenCL device and work that it does in the order given. One object serves one thread.
/// Every call throws IoError with OpenCL's own words when the device fails.
class DeviceQueue {
public:
    /// Work items that share local memory; every kernel is run in whole groups along its first axis.
    static constexpr std::size_t group = 64;

    /// Takes: source in OpenCL C 1.2, which is compiled once in the life of the process; the stage that asks, for
    /// messages. Throws: BadParameter as opencl_device(); IoError with the compiler's words.
    DeviceQueue(char const* stage, std::string_view source);

    OpenClDevice const& device() const { return *device_; }

    /// Numbers that are 0.
    template <class T> DeviceArray<T> zeros(std::int64_t count) {
        return {take(count * static_cast<std::int64_t>(sizeof(T))), count};
    }
    /// A copy of these with zeros, as many as margin says, before and after.
    template <class T> DeviceArray<T> copy_of(std::span<T const> values, std::int64_t margin = 0) {
        auto array = zeros<T>(static_cast<std::int64_t>(values.size()) + 2 * margin);
        write(array.handle(), static_cast<std::size_t>(margin) * sizeof(T), values.data(), values.size_bytes());
        return array;
    }
    /// Copies what stands behind the margin to the host, after all that was queued before.
    template <class T> void read(DeviceArray<T> const& from, std::span<T> to, std::int64_t margin = 0) {
        read(from.handle(), static_cast<std::size_t>(margin) * sizeof(T), to.data(), to.size_bytes());
    }

    /// Queues a kernel. Takes: columns and rows of work items, of which columns is rounded up to whole groups; arrays
    /// and numbers in the order of the kernel's parameters.
    template <class... Arguments>
    void run(char const* kernel, std::int64_t columns, std::int64_t rows, Arguments const&... arguments) {
        void* const k = kernel_of(kernel);
        unsigned at = 0;
        (set(k, at++, arguments), ...);
        start(k, kernel, columns, rows);
    }
    /// Waits until all is done.
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
