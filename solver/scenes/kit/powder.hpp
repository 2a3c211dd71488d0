// Parameters of the powder of a granular scene and of the numerics of its contacts, with the same names in every scene.
// A scene copies the block, sets the defaults and bounds of its study, and declares the parameters that it offers:
//
//     inline constexpr Powder powder = [] { Powder p; p.diameter = p.diameter.with(45e-6, {1e-7, 0.1}); return p; }();
//     info.parameters = declared(powder.diameter, powder.friction, opening);
//     const dem::Material material = powder.material(inputs);
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/particles/size_table.hpp"
#include "solver/scenes/kit/parameter.hpp"

namespace grainsweep::kit {

enum class SizeLaw { monodisperse, weibull_wide, weibull_narrow, lognormal, uniform, file };

struct Powder {
    Real diameter{
        "diameter", "m", "diameter D of the particles; of unequal ones see size_distribution", 0.002, {1e-6, 1e-2}};
    Choice<SizeLaw, 6> size_distribution{
        "size_distribution",
        "by number: 'monodisperse' all D; 'weibull_wide', 'weibull_narrow' the five classes of Wu (2020), 4.44, "
        "22.76, 40.78, 26.91, 5.11 % of (1 + k w) D, k = -2 ... 2, w = 0.15 and 0.1; 'lognormal' with mean D, without "
        "its 0.5 % smallest and largest; 'uniform' between (1 - size_spread) D and (1 + size_spread) D; 'file' as in "
        "size_file",
        {{{"monodisperse", SizeLaw::monodisperse},
          {"weibull_wide", SizeLaw::weibull_wide},
          {"weibull_narrow", SizeLaw::weibull_narrow},
          {"lognormal", SizeLaw::lognormal},
          {"uniform", SizeLaw::uniform},
          {"file", SizeLaw::file}}}};
    Real size_spread{"size_spread",
                     "1",
                     "'lognormal': standard deviation of the logarithm of the diameter, before truncation; 'uniform': "
                     "half-width over D",
                     0.2,
                     {0, 0.5},
                     {if_word("size_distribution", "lognormal", "uniform")}};
    FileOr size_file{
        "size_file",
        "measured sizes: a CSV file with the header diameter,number_fraction or diameter,volume_fraction (classes), "
        "diameter,number_below or diameter,volume_below (cumulative, from 0 to 1, evenly filled between lines); "
        "diameters in m, ascending. They are taken as they are: D, the unit of lengths, must lie among them",
        "none",
        [](std::string_view csv) { (void)particles::SizeTable::read(csv); },
        {if_word("size_distribution", "file")}};
    Real density{"density", "kg/m3", "density of the particles", 7980, {100, 25000}};
    Real youngs_modulus{"youngs_modulus", "Pa", "Young's modulus of particles and walls", 21e6, {1e5, 1e12}};
    Real poisson_ratio{"poisson_ratio", "1", "Poisson's ratio of particles and walls", 0.3, {0, 0.49}};
    Real restitution{"restitution", "1", "restitution of particles and walls", 0.5, above(0, 1)};
    Real friction{"friction", "1", "Coulomb friction of particles and walls", 0.2, {0, 2}};
    Real rolling_friction{"rolling_friction",
                          "1",
                          "rolling friction of particles and walls: tangent of the steepest slope a particle stands on",
                          0.0,
                          {0, 1},
                          {if_set("friction")}};
    Choice<dem::RollingLaw, 3> rolling_law{
        "rolling_law",
        "how rolling is resisted: 'epsd' by an elastic-plastic spring with a dashpot, 'epsd_liggghts' by the same with "
        "LIGGGHTS 3.8's angle at walls, 'cdt' by a constant torque against the relative rotation",
        {{{"epsd", dem::RollingLaw::epsd},
          {"epsd_liggghts", dem::RollingLaw::epsd_liggghts},
          {"cdt", dem::RollingLaw::cdt}}},
        {if_set("rolling_friction")}};
    Choice<dem::TangentialLimit, 2> tangential_limit{
        "tangential_limit",
        "limited to friction times the normal force: 'sum' tangential spring and dashpot together, 'spring' the spring "
        "alone, as LIGGGHTS does; rolling moments likewise",
        {{{"sum", dem::TangentialLimit::sum}, {"spring", dem::TangentialLimit::spring}}},
        {if_set("friction")}};
    Real cohesion{"cohesion", "J/m3",   "cohesion energy density of 'sjkr', 'sjkr2', 'paper'",
                  0.0,        {0, 1e6}, {if_word("cohesion_law", "sjkr", "sjkr2", "paper")}};
    Choice<dem::CohesionLaw, 5> cohesion_law{
        "cohesion_law",
        "attraction: cohesion times an area, 'sjkr' cut of the spheres, 'sjkr2' 4 pi R* d, 'paper' "
        "pi (2 R* d - d^2)/4; or by surface_energy, 'jkr' Johnson, Kendall & Roberts, 'dmt' Derjaguin, Muller & "
        "Toporov",
        {{{"sjkr", dem::CohesionLaw::sjkr},
          {"sjkr2", dem::CohesionLaw::sjkr2},
          {"paper", dem::CohesionLaw::paper},
          {"jkr", dem::CohesionLaw::jkr},
          {"dmt", dem::CohesionLaw::dmt}}}};
    Real surface_energy{"surface_energy",
                        "J/m2",
                        "work of adhesion w of 'jkr' and 'dmt': of two surfaces of surface energy g each, 2 g",
                        0.0,
                        {0, 10},
                        {if_word("cohesion_law", "jkr", "dmt")}};
    Real time_step{"time_step",
                   "s",
                   "time step; 0: time_step_fraction of the shorter of the Rayleigh time and the Hertz "
                   "contact time at the fastest expected impact",
                   0.0,
                   {0, 1e-3}};
    Real time_step_fraction{
        "time_step_fraction",  "1", "time step over the shorter of the two limits", 0.2, above(0, 1),
        {if_zero("time_step")}};
    Choice<dem::Method::Precision, 2> precision{
        "precision",
        "arithmetic: 'mixed' vectorised, exact position differences, single precision forces; 'double' the clear "
        "reference",
        {{{"mixed", dem::Method::Precision::mixed}, {"double", dem::Method::Precision::double_precision}}}};

    /// Returns the material from all parameters from density to cohesion_law.
    [[nodiscard]] dem::Material material(const Inputs& inputs) const;
    [[nodiscard]] dem::Method method(const Inputs& inputs) const;
};

/// Returns the largest attraction of two equal spheres at rest, N; for cohesion by area, to first order in the overlap.
[[nodiscard]] double pull_off_force(const dem::Material& material, double diameter);

}  // namespace grainsweep::kit
