// Arrays of numbers to and from the bytes of a saved state, in the order they are named.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace grainsweep::flow {

template <class T>
requires std::is_trivially_copyable_v<T>
void append_bytes(std::vector<std::byte>& into, std::span<const T> values) {
    const std::size_t before = into.size();
    into.resize(before + values.size_bytes());
    if (!values.empty()) std::memcpy(into.data() + before, values.data(), values.size_bytes());
}

template <class T>
requires std::is_trivially_copyable_v<T>
void append_bytes(std::vector<std::byte>& into, const T& value) {
    append_bytes(into, std::span<const T>(&value, 1));
}

/// Fills `values` from the front of `from` and removes that part. Throws std::invalid_argument when it is too short.
template <class T>
requires std::is_trivially_copyable_v<T>
void take_bytes(std::span<const std::byte>& from, std::span<T> values) {
    if (from.size() < values.size_bytes()) throw std::invalid_argument("the saved state is of another shape");
    if (!values.empty()) std::memcpy(values.data(), from.data(), values.size_bytes());
    from = from.subspan(values.size_bytes());
}

template <class T>
requires std::is_trivially_copyable_v<T>
void take_bytes(std::span<const std::byte>& from, T& value) {
    take_bytes(from, std::span<T>(&value, 1));
}

/// Of what was read: false where no state has such a value. Throws std::invalid_argument.
inline void require_possible(bool possible) {
    if (!possible) throw std::invalid_argument("the saved state holds values that no state has");
}

}  // namespace grainsweep::flow
