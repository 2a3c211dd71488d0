// The frame of a DEM experiment's checkpoint: the number of its format, what the scene writes, the engine.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <stdexcept>

namespace grainsweep::kit {

/// `write(out)` puts what the scene has besides its engine.
template <class Write>
void write_checkpoint(Bytes& into, std::uint64_t format, const dem::Engine& engine, Write&& write) {
    into.clear();
    Bytes of_engine;
    engine.save(of_engine);
    ByteWriter out(into);
    out.put(format);
    write(out);
    out.put(of_engine);
}

/// At what the scene wrote. Throws std::invalid_argument where the format is another.
[[nodiscard]] inline ByteReader open_checkpoint(std::span<const std::byte> from, std::uint64_t format) {
    ByteReader in(from);
    std::uint64_t theirs = 0;
    in.get(theirs);
    if (theirs != format) throw std::invalid_argument("checkpoint of another scene");
    return in;
}

/// The engine's bytes, with which a checkpoint ends. Throws std::invalid_argument where it does not.
[[nodiscard]] inline Bytes engine_at_end(ByteReader& in) {
    Bytes engine;
    in.get(engine);
    in.finish();
    return engine;
}

}  // namespace grainsweep::kit
