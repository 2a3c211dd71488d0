// Inputs of a TPMS discharge: parameters with their defaults (the study's table 1), and a case's inputs as numbers.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/geometry/tpms.hpp"
#include "solver/scenes/values.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace grainsweep {

[[nodiscard]] std::vector<ParameterSpec> tpms_discharge_parameters();
/// Returns the contents of the packing's file. Throws std::invalid_argument if it is not among the files.
[[nodiscard]] const std::string& tpms_packing_text(const Inputs& inputs, const Files& files);

struct TpmsQuestion {
    geometry::TpmsCell cell = geometry::TpmsCell::schwarz_p;
    int side = +1;
    double edge = 100;           ///< L, diameters
    double shell = 4;            ///< diameters
    bool packing_given = false;  ///< the packing is a file
    double packing_fraction = 0.62;
    std::uint64_t packing_seed = 1;
    double diameter = 45e-6;  ///< m
    dem::Material material;
    dem::Surface wall;      ///< of the frozen shell
    double gravity = 9.81;  ///< m/s2
    std::array<double, 3> down{0, 0, -1};
    dem::Shaking shaking;  ///< of the whole cell
    double end_time = 10;  ///< in units of free_fall_time()
    bool stop_when_quiet = true;
    double time_step = 1e-6;  ///< s
    double rest_speed = 0;    ///< in units of free_fall_speed()
    dem::Method::Precision precision = dem::Method::Precision::mixed;

    /// Takes complete inputs and the case's seed. Throws std::invalid_argument if their combination is impossible.
    TpmsQuestion(const Inputs& inputs, std::uint64_t seed);

    [[nodiscard]] double length() const { return edge * diameter; }  ///< L, m
    [[nodiscard]] double free_fall_time() const;                     ///< t* = sqrt(2 L/g), s
    [[nodiscard]] double free_fall_speed() const;                    ///< sqrt(2 g L), m/s
    [[nodiscard]] double standard_weight() const;                    ///< m 9.81 m/s2, N
};

}  // namespace grainsweep
