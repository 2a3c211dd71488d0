#include "tests/support/few_spheres.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/geometry/vector.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

class Draws {
public:
    explicit Draws(std::uint64_t seed) : random_(seed) {}

    double even(double low, double high) { return low + (high - low) * random_.uniform(); }
    double ratio(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
    bool once_in(double times) { return random_.uniform() * times < 1; }
    std::string word(std::initializer_list<const char*> words) {
        return *(words.begin() + static_cast<std::ptrdiff_t>(random_.uniform() * static_cast<double>(words.size())));
    }

private:
    stats::Generator random_;
};

/// Lengths in D, speeds in sqrt(g D), times in sqrt(D/g).
struct Units {
    double diameter = 0, gravity = 0, largest = 1;  // of d/D
    [[nodiscard]] double time() const { return std::sqrt(diameter / gravity); }
    [[nodiscard]] double speed() const { return std::sqrt(diameter * gravity); }
};

double volume(double diameter) {
    return std::numbers::pi / 6 * diameter * diameter * diameter;
}

void draw_cohesion(Inputs& in, const Units& unit, Draws& draw) {
    if (draw.once_in(2)) return;
    const double weight = volume(unit.diameter) * std::get<double>(in.at("density")) * unit.gravity;
    const double bond = draw.ratio(0.1, 3);
    const std::string law = draw.word({"sjkr", "sjkr2", "paper", "jkr", "dmt"});
    in["cohesion_law"] = law;
    if (law == "jkr" || law == "dmt") {
        in["surface_energy"] = std::min(10.0, bond * weight / (std::numbers::pi * unit.diameter));
        return;
    }
    // (c k R)^3/(6 E*^2 R) = bond times the weight (kit::bond_number), c = pi.
    const double modulus = std::get<double>(in.at("youngs_modulus")) / 1.82, radius = unit.diameter / 2;
    const double k = std::cbrt(bond * weight * 6 * modulus * modulus * radius) / (std::numbers::pi * radius);
    in["cohesion"] = std::min(k, 1e6);
}

Units draw_powder(Inputs& in, bool of_unequal, Draws& draw) {
    Units unit{draw.ratio(5e-5, 0.02), draw.ratio(1, 30)};
    in["diameter"] = unit.diameter;
    in["gravity"] = unit.gravity;
    in["density"] = draw.ratio(500, 10000);
    // Stiff enough that an impact after a fall of ten diameters overlaps by less than a tenth.
    const double soft = 4e3 * std::get<double>(in["density"]) * unit.gravity * unit.diameter;
    in["youngs_modulus"] = std::max(1e5, soft * draw.ratio(1, 60));
    in["restitution"] = draw.once_in(4) ? 1.0 : draw.even(0.02, 1);
    in["friction"] = draw.once_in(4) ? 0.0 : draw.even(0, 2);
    in["rolling_friction"] = 0.0;
    if (std::get<double>(in["friction"]) > 0 && draw.once_in(2)) {
        in["rolling_friction"] = draw.even(0.01, 1);
        in["rolling_law"] = draw.word({"cdt", "epsd", "epsd_liggghts"});
    }
    in["precision"] = draw.word({"mixed", "mixed", "double"});
    if (of_unequal && draw.once_in(2)) {
        const std::string law = draw.word({"lognormal", "uniform", "weibull_wide", "weibull_narrow"});
        in["size_distribution"] = law;
        const double spread = draw.even(0.05, 0.5);
        if (law == "lognormal" || law == "uniform") in["size_spread"] = spread;
        unit.largest = law == "lognormal" ? std::exp(2.6 * spread) : 1.5;
    }
    draw_cohesion(in, unit, draw);
    return unit;
}

void lay_out(std::string_view scene, Inputs& in, const Units& unit, Draws& draw) {
    const auto count = static_cast<std::int64_t>(draw.even(1, 21));
    const double d = unit.diameter, t = unit.time();
    if (scene != "tpms_discharge" && scene != "powder_spreading") in["particles"] = count;
    if (scene == "heap") {
        in["tube_diameter"] = d * unit.largest * draw.even(3.2, 8);
        in["lift_speed"] = unit.speed() * draw.ratio(0.05, 2);
        in["settle_time"] = t * draw.ratio(5, 100);
        in["end_time"] = t * draw.ratio(10, 100);
    } else if (scene == "hopper") {
        const double across = d * unit.largest * draw.even(3.2, 8);
        in["container_diameter"] = std::max(1e-4, across);
        in["opening_size"] = std::max(1e-4, across) * draw.even(0.3, 0.9);
        if (draw.once_in(3)) {
            in["opening"] = std::string("slot");
            in["slot_length"] = d * unit.largest * draw.even(3.2, 8);
        } else if (draw.once_in(2)) {
            in["shape"] = std::string("conical");
            in["half_angle"] = draw.even(10, 70);
        }
        in["settle_time"] = t * draw.ratio(5, 100);
        in["end_time"] = t * draw.ratio(10, 100);
        in["frame_interval"] = t;
    } else if (scene == "rotating_drum") {
        in["drum_diameter"] = std::max(1e-4, d * unit.largest * draw.even(4.2, 10));
        in["length"] = d * unit.largest * draw.even(3.2, 6);
        if (draw.once_in(3)) in["ends"] = std::string("plates");
        const double radius = std::get<double>(in["drum_diameter"]) / 2;
        in["rpm"] = 30 / std::numbers::pi * std::sqrt(draw.ratio(0.003, 2) * unit.gravity / radius);
        in["turning_time"] = t * draw.ratio(5, 60);
        in["measured_time"] = t * draw.ratio(10, 60);
        in["frame_interval"] = t;
    } else if (scene == "powder_spreading") {
        const double width = std::max(3.0, 2.2 * unit.largest) * draw.even(1, 2);
        in["width"] = width;
        in["layer_area"] = static_cast<double>(count) * volume(d) / (width * d);
        in["travel"] = d * unit.largest * draw.ratio(8, 30);
        in["layer_beyond"] = d * unit.largest * draw.even(2, 8);
        in["gap"] = d * draw.ratio(0.5, 3);
        in["speed"] = std::max(1e-3, unit.speed() * draw.ratio(0.3, 10));
        in["settle_time"] = t * draw.ratio(5, 60);
        in["blade_thickness"] = d * draw.ratio(0.5, 5);
        if (draw.once_in(3)) {
            in["tool"] = std::string("roller");
            in["roller_diameter"] = std::min(0.1, d * draw.ratio(3, 20));
            in["roller_spin"] = draw.even(-2, 2);
        }
    } else {
        in["cell"] = draw.word({"schwarz_p", "gyroid", "diamond", "iwp", "frd"});
        in["edge"] = draw.even(8, 12);
        in["shell"] = draw.even(0.5, 2.5);
        in["packing_fraction"] = draw.even(0.05, 0.09);
        in["packing_seed"] = std::int64_t{0};
        in["end_time"] = draw.ratio(1, 20);
        in["settle_rule"] = std::string("none");
        in["tilt"] = draw.once_in(2) ? 0.0 : draw.even(0, 60);
    }
}

/// Of the step that the scene takes at a fraction of 1; of tpms_discharge, which takes any, by the free fall.
double step_limit(std::string_view scene, const FewSpheres& question, const Units& unit) {
    Inputs in = question.inputs;
    if (scene == "tpms_discharge") {
        dem::Material m;
        m.youngs_modulus = std::get<double>(in.at("youngs_modulus"));
        m.poisson_ratio = std::get<double>(in.at("poisson_ratio"));
        m.density = std::get<double>(in.at("density"));
        const double fall = std::sqrt(2 * unit.gravity * std::get<double>(in.at("edge")) * unit.diameter);
        return std::min(dem::rayleigh_time(m, unit.diameter / 2), dem::hertz_contact_time(m, unit.diameter / 2, fall));
    }
    in["time_step"] = 0.0;
    in["time_step_fraction"] = 1.0;
    NoArtefacts none;
    const auto made = campaign::scene_named(scene)->make(in, question.seed, none, {});
    made->advance(1e-300);
    return made->time();
}

double kinetic(const Snapshot& picture) {
    const auto found = picture.vectors.find("velocity");
    double energy = 0;  // over the density
    if (picture.positions.empty()) return energy;
    const auto& diameter = picture.scalars.at("diameter");
    for (std::size_t i = 0; i < picture.positions.size(); ++i) {
        const auto& v = found->second[i];
        energy += volume(diameter[i]) / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    return energy;
}

}  // namespace

const std::vector<std::string_view>& granular_scenes() {
    static const std::vector<std::string_view> all = {"powder_spreading", "tpms_discharge", "hopper", "heap",
                                                      "rotating_drum"};
    return all;
}

FewSpheres few_spheres(std::string_view scene, std::uint64_t number, double step) {
    Draws draw(stats::bits_at(36, std::hash<std::string_view>{}(scene), number));
    FewSpheres made;
    made.inputs = campaign::scene_named(scene)->defaults();
    made.seed = number + 1;
    const Units unit = draw_powder(made.inputs, scene != "tpms_discharge", draw);
    lay_out(scene, made.inputs, unit, draw);
    try {
        made.step_limit = step_limit(scene, made, unit);
    } catch (const std::invalid_argument&) {
        return made;
    }
    made.inputs["time_step"] = std::min(1e-3, step * made.step_limit);
    return made;
}

Fate fate_of(std::string_view scene, const FewSpheres& question) {
    Fate fate;
    NoArtefacts none;
    try {
        const auto run = campaign::scene_named(scene)->make(question.inputs, question.seed, none, {});
        const double look = std::sqrt(std::get<double>(question.inputs.at("diameter")) /
                                      std::get<double>(question.inputs.at("gravity")));  // half a fall by D
        while (!run->finished() && run->health().stable()) {
            run->advance(run->time() + look);
            fate.last_kinetic = kinetic(run->snapshot());
            fate.most_kinetic = std::max(fate.most_kinetic, fate.last_kinetic);
        }
        fate.fault = run->health().reason;
    } catch (const std::invalid_argument& reason) {
        fate.refused = reason.what();
    }
    return fate;
}

}  // namespace grainsweep::tests
