// Frame of a DEM experiment's checkpoint: number of its format, data of the scene, engine.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <stdexcept>

namespace grainsweep::kit {

/// Writes a checkpoint; `write(out)` writes the data of the scene without its engine.
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

/// Returns a reader at the data of the scene. Throws std::invalid_argument for another format.
[[nodiscard]] inline ByteReader open_checkpoint(std::span<const std::byte> from, std::uint64_t format) {
    ByteReader in(from);
    std::uint64_t theirs = 0;
    in.get(theirs);
    if (theirs != format) throw std::invalid_argument("checkpoint of another scene");
    return in;
}

/// Returns the engine's bytes at the end of a checkpoint. Throws std::invalid_argument if there are other bytes.
[[nodiscard]] inline Bytes engine_at_end(ByteReader& in) {
    Bytes engine;
    in.get(engine);
    in.finish();
    return engine;
}

}  // namespace grainsweep::kit
