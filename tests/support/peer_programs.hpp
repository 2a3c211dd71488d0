// LIGGGHTS and LAMMPS, run on exactly the states our engine is given, for times and figures side by side.
//
// Both are looked for on the PATH (Debian packages liggghts and lammps); a program that is not there is said to be
// absent, never imitated. Times are user seconds of the child process as the kernel counts them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

[[nodiscard]] bool installed(const std::string& program);

struct Ran {
    int code = -1;
    double user_seconds = 0, wall_seconds = 0;
    std::string out;
};
/// Runs a program to its end in `folder`, one thread, standard output and error caught.
[[nodiscard]] Ran run_timed(const std::vector<std::string>& argv, const std::filesystem::path& folder);

/// Header and particles of a data file; LIGGGHTS's granular and LAMMPS's sphere style agree.
void write_data(const dem::Setup& setup, int types, const std::filesystem::path& file);
/// Material properties of LIGGGHTS for `types` types of one material.
[[nodiscard]] std::string properties(const dem::Material& material, int types);
[[nodiscard]] std::string gravity_line(const dem::Vec3& gravity);

/// What a state says in a few numbers: means over the mobile particles.
struct Figures {
    double kinetic_energy = 0;  ///< J, translation
    double velocity_x = 0;      ///< m/s
    double coordination = 0;    ///< contacts per mobile particle, frozen partners included
};
/// Of an engine's state; pairs by brute cells. Periodic in x and y as the setup says.
[[nodiscard]] Figures figures_of(const dem::State& state, const dem::Setup& setup);

/// A dense flow or bed (no walls, frozen particles allowed) as a deck for one of the programs.
struct Peer {
    enum class Program { liggghts, lammps };
    Program program = Program::liggghts;
    double skin = 0;         ///< m
    std::int64_t steps = 0;  ///< after `warm` steps
    std::int64_t warm = 100;
    /// Lists anew every step: LIGGGHTS then forgets the tangential displacement of a pair as it separates, as the law
    /// says; otherwise a pair that meets again before its lists are rebuilt finds the old one.
    bool forgetful = false;
};
/// nullopt where the program cannot: LAMMPS's gran/hertz/history knows no cohesion.
[[nodiscard]] std::optional<std::string> deck_of(const dem::Setup& setup, const Peer& peer);
/// The state as the data file `bed.data` both programs read; frozen particles are type 2.
void write_bed(const dem::Setup& setup, const std::filesystem::path& folder);
/// The last line of figures such a run printed.
[[nodiscard]] Figures printed_figures(const std::string& out);

/// A spreading case: the same start, settling, blade (a closed surface mesh) and steps; no output on the way.
struct SpreadingPeer {
    double friction = 0, diameter = 0, gap = 0, speed = 0;
    double time_step = 1e-5, settle_time = 0.15, travel = 0.07;
};
/// Writes deck `in.spread`, blade.stl and start.data.
void write_spreading(const SpreadingPeer& question, const dem::Setup& start, const std::filesystem::path& folder);

}  // namespace grainsweep::tests
