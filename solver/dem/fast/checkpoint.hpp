// Bytes of an engine's state, written and read by the same list of members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"

namespace grainsweep::dem::fast {

class Writer {
public:
    explicit Writer(std::vector<std::byte>& into) : out_(into) { into.clear(); }

    void value(const auto& v) { out_.put(v); }
    template <class T>
    void column(const Column<T>& c, std::size_t count) {
        out_.put_all(std::span<const T>(c.data(), count));
    }
    void list(const auto& v) { out_.put(v); }
    void text(const std::string& s) { out_.put(s); }

private:
    ByteWriter out_;
};

class Reader {
public:
    explicit Reader(std::span<const std::byte> from) : in_(from) {}

    void value(auto& v) { in_.get(v); }
    template <class T>
    void column(Column<T>& c, std::size_t count) {
        if (count > in_.left() / sizeof(T)) throw std::invalid_argument("the checkpoint ends too early");
        c.hold(count + spare);
        in_.get_all(std::span<T>(c.data(), count));
    }
    void list(auto& v) { in_.get(v); }
    void text(std::string& s) { in_.get(s); }
    void finish() const { in_.finish(); }

private:
    ByteReader in_;
};

/// Data that must agree between the writing and the reading engine; compared by its bytes, including padding.
struct Seal {
    std::uint64_t format;
    std::int32_t width;
    Needs needs;
    Constants constants;
    Shaking shaking;
    double rest_speed;
};
inline constexpr std::uint64_t checkpoint_format = 0x6773776565703231;  // changes with the layout of the bytes that
                                                                        // follow

}  // namespace grainsweep::dem::fast
