// Checkpoint bytes: trivially copyable values and columns of them, written and read in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace grainsweep::particles {

class ByteWriter {
public:
    explicit ByteWriter(std::vector<std::byte>& into) : into_(&into) {}

    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put(const T& value) { append(&value, sizeof value); }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put(const std::vector<T>& column) {
        put(static_cast<std::uint64_t>(column.size()));
        append(column.data(), column.size() * sizeof(T));
    }
    void put(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        append(text.data(), text.size());
    }

private:
    void append(const void* data, std::size_t size) {
        const auto* first = static_cast<const std::byte*>(data);
        into_->insert(into_->end(), first, first + size);
    }
    std::vector<std::byte>* into_;
};

/// Throws std::invalid_argument where the bytes end too early or are not those of such a state.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> from) : from_(from) {}

    template <class T>
    requires std::is_trivially_copyable_v<T>
    void get(T& value) { take(&value, sizeof value); }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void get(std::vector<T>& column) {
        column.resize(count(sizeof(T)));
        take(column.data(), column.size() * sizeof(T));
    }
    /// A byte that is neither 0 nor 1 is no truth value.
    void get(bool& truth) {
        std::uint8_t byte = 0;
        get(byte);
        require(byte <= 1);
        truth = byte == 1;
    }
    void get(std::string& text) {
        text.resize(count(1));
        take(text.data(), text.size());
    }
    /// Of what was read: false where no state has such a value.
    static void require(bool possible) {
        if (!possible) throw std::invalid_argument("checkpoint holds values that no state has");
    }
    void finish() const {
        if (!from_.empty()) throw std::invalid_argument("checkpoint is longer than the state it should hold");
    }

private:
    std::size_t count(std::size_t size) {
        std::uint64_t n = 0;
        get(n);
        if (n > from_.size() / size) throw std::invalid_argument("checkpoint ends too early");
        return n;
    }
    void take(void* data, std::size_t size) {
        if (size > from_.size()) throw std::invalid_argument("checkpoint ends too early");
        if (size > 0) std::memcpy(data, from_.data(), size);
        from_ = from_.subspan(size);
    }
    std::span<const std::byte> from_;
};

}  // namespace grainsweep::particles
