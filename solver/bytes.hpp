// Conversion of values and columns of values to and from the bytes of a saved state, in the order in which they are
// named. Values are little-endian as in memory; lengths have 64 bits. Every read is bounded: if bytes end too early,
// std::invalid_argument is thrown before any byte beyond them is read or memory is allocated.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace grainsweep {

static_assert(std::endian::native == std::endian::little);

template <class T>
inline constexpr bool is_span = false;
template <class T, std::size_t N>
inline constexpr bool is_span<std::span<T, N>> = true;
/// Types whose bytes are their value; not spans and pointers, which refer to other bytes.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !is_span<T>;

/// Appends the values without their number.
template <Plain T>
void append_bytes(std::vector<std::byte>& into, std::span<const T> values) {
    const std::size_t before = into.size();
    into.resize(before + values.size_bytes());
    if (!values.empty()) std::memcpy(into.data() + before, values.data(), values.size_bytes());
}
template <Plain T>
void append_bytes(std::vector<std::byte>& into, const T& value) {
    append_bytes(into, std::span<const T>(&value, 1));
}

/// Fills `values` from the front of `from` and removes that part.
template <Plain T>
void take_bytes(std::span<const std::byte>& from, std::span<T> values) {
    if (from.size() < values.size_bytes()) throw std::invalid_argument("the checkpoint ends too early");
    if (!values.empty()) std::memcpy(values.data(), from.data(), values.size_bytes());
    from = from.subspan(values.size_bytes());
}
template <Plain T>
void take_bytes(std::span<const std::byte>& from, T& value) {
    take_bytes(from, std::span<T>(&value, 1));
}
/// Reads the number of values of that size that follow; all of them must be there.
[[nodiscard]] inline std::size_t take_count(std::span<const std::byte>& from, std::size_t size) {
    std::uint64_t n = 0;
    take_bytes(from, n);
    if (n > from.size() / size) throw std::invalid_argument("the checkpoint ends too early");
    return n;
}

/// Throws std::invalid_argument if a value that was read is impossible.
inline void require_possible(bool possible) {
    if (!possible) throw std::invalid_argument("the checkpoint holds values that no state has");
}

class ByteWriter {
public:
    explicit ByteWriter(std::vector<std::byte>& into) : into_(&into) {}

    template <Plain T>
    void put(const T& value) {
        append_bytes(*into_, value);
    }
    /// Writes values without their number.
    template <Plain T>
    void put_all(std::span<const T> values) {
        append_bytes(*into_, values);
    }
    /// Writes the number of values and the values.
    template <Plain T>
    void put(const std::vector<T>& column) {
        put(static_cast<std::uint64_t>(column.size()));
        put_all(std::span<const T>(column));
    }
    void put(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        put_all(std::span<const char>(text));
    }

private:
    std::vector<std::byte>* into_;
};

class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> from) : from_(from) {}

    template <Plain T>
    void get(T& value) {
        take_bytes(from_, value);
    }
    template <Plain T>
    void get_all(std::span<T> values) {
        take_bytes(from_, values);
    }
    template <Plain T>
    void get(std::vector<T>& column) {
        column.resize(take_count(from_, sizeof(T)));
        get_all(std::span<T>(column));
    }
    /// Reads a bool; a byte that is neither 0 nor 1 throws.
    void get(bool& truth) {
        std::uint8_t byte = 0;
        get(byte);
        require(byte <= 1);
        truth = byte == 1;
    }
    void get(std::string& text) {
        text.resize(take_count(from_, 1));
        get_all(std::span<char>(text));
    }
    static void require(bool possible) { require_possible(possible); }
    [[nodiscard]] std::size_t left() const { return from_.size(); }
    void finish() const {
        if (!from_.empty()) throw std::invalid_argument("the checkpoint is longer than the state it should hold");
    }

private:
    std::span<const std::byte> from_;
};

}  // namespace grainsweep
