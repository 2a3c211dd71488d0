// Four granular experiments at walls, each as a setup of ours and as a deck of LIGGGHTS 3.8 from the same start: the
// drum, hopper, heap and roller of tests/reference/walls (section 4 of its README).
//
// Powder starts on a jittered lattice of spacing 1.15 d and falls; the walls then change as the experiment says.
// LIGGGHTS has no cylinder that travels: its roller stands still and the powder and the base come towards it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// What our walls are where LIGGGHTS's are triangles.
enum class WallsAs { curved, triangles };

struct WallDeck {
    std::string name;
    dem::Setup start;         ///< with the walls among which the powder settles
    std::int64_t settle = 0;  ///< steps
    std::int64_t steps = 0;   ///< after these
    /// From then on; none: those of the start go on.
    std::vector<dem::Wall> then;
    std::string settling, running;                    ///< walls of both stages, in LIGGGHTS's words
    std::map<std::string, std::string> files;         ///< STL, by name
    dem::Vec3 travelled{};                            ///< by LIGGGHTS's frame of reference until the end, m
    std::string measured;                             ///< what the figure is
    std::function<double(const dem::State&)> figure;  ///< of the state at the end, to see that both did the same
};

[[nodiscard]] WallDeck drum_deck();
[[nodiscard]] WallDeck hopper_deck(WallsAs walls);
[[nodiscard]] WallDeck heap_deck(WallsAs walls);
[[nodiscard]] WallDeck roller_deck();

/// Writes in.walls, start.data and the STL files; `skin` of LIGGGHTS's lists, m. It writes one frame, at the end.
void write_deck(const WallDeck& deck, double skin, const std::filesystem::path& folder);
/// That frame, as it would be seen from ours.
[[nodiscard]] dem::State last_frame(const WallDeck& deck, const std::filesystem::path& folder);
/// Particles times steps, from the numbers of particles that a run printed on its way.
[[nodiscard]] double particle_steps(const std::string& out);

}  // namespace grainsweep::tests
