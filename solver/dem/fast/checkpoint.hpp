// Bytes of an engine's state, written and read by the same list of what there is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"

namespace grainsweep::dem::fast {

class Writer {
public:
    explicit Writer(std::vector<std::byte>& into) : into_(into) { into_.clear(); }

    template <class T>
    requires std::is_trivially_copyable_v<T>
    void value(const T& v) { bytes(&v, sizeof v); }
    template <class T>
    void column(const Column<T>& c, std::size_t count) {
        bytes(c.data(), count * sizeof(T));
    }
    template <class T>
    void list(const std::vector<T>& v) {
        value(v.size());
        bytes(v.data(), v.size() * sizeof(T));
    }
    void text(const std::string& s) {
        value(s.size());
        bytes(s.data(), s.size());
    }

private:
    void bytes(const void* from, std::size_t size) {
        if (size == 0) return;
        const std::size_t at = into_.size();
        into_.resize(at + size);
        std::memcpy(into_.data() + at, from, size);
    }
    std::vector<std::byte>& into_;
};

/// Throws std::invalid_argument where the bytes end early.
class Reader {
public:
    explicit Reader(std::span<const std::byte> from) : from_(from) {}

    template <class T>
    requires std::is_trivially_copyable_v<T>
    void value(T& v) { bytes(&v, sizeof v); }
    template <class T>
    void column(Column<T>& c, std::size_t count) {
        require(count <= from_.size() / sizeof(T));
        c.hold(count + spare);
        bytes(c.data(), count * sizeof(T));
    }
    template <class T>
    void list(std::vector<T>& v) {
        std::size_t n = 0;
        value(n);
        require(n <= from_.size() / sizeof(T));
        v.resize(n);
        bytes(v.data(), n * sizeof(T));
    }
    void text(std::string& s) {
        std::size_t n = 0;
        value(n);
        require(n <= from_.size());
        s.resize(n);
        bytes(s.data(), n);
    }
    [[nodiscard]] bool finished() const { return from_.empty(); }

private:
    static void require(bool enough) {
        if (!enough) throw std::invalid_argument("the checkpoint ends early");
    }
    void bytes(void* to, std::size_t size) {
        require(size <= from_.size());
        if (size == 0) return;
        std::memcpy(to, from_.data(), size);
        from_ = from_.subspan(size);
    }
    std::span<const std::byte> from_;
};

/// What must agree between the engine that wrote and the one that reads; compared by its bytes, padding too.
struct Seal {
    std::uint64_t format;
    std::int32_t width;
    Needs needs;
    Constants constants;
    Shaking shaking;
    double rest_speed;
};
inline constexpr std::uint64_t checkpoint_format = 0x67737765657037;  // changes with the layout of what follows

}  // namespace grainsweep::dem::fast
