#include "sweep/campaign/machine_keys.hpp"

#include "solver/machine/shapes.hpp"
#include "solver/machine/spec.hpp"

#include <array>
#include <vector>

namespace grainsweep::campaign::machine_keys {
namespace {

using MachineKey = Field::Kind;

constexpr std::array<std::string_view, 6> spread_words = {"monodisperse", "uniform",        "lognormal",
                                                          "weibull_wide", "weibull_narrow", "file"};
constexpr std::array<std::string_view, 3> file_words = {"sizes", "stl", "packing"};
constexpr std::array<std::string_view, 3> by_words = {"count", "mass", "volume"};
constexpr std::array<std::string_view, 5> as_words = {"lattice", "random", "rain", "packed", "cells"};
constexpr std::array<std::string_view, 3> part_words = {"centre", "part", "whole"};

constexpr auto parameter_keys = std::to_array<Field>({
    {"unit", MachineKey::text,
     "unit of its values; in expressions NAME is the value in SI units and NAME_UNIT the one "
     "in this unit",
     "\"1\""},
    {"counted_in", MachineKey::text,
     "instead of a unit, of a pure number: what it counts, as shown, such as \"particle diameters\""},
    needed({"default", MachineKey::value, "value where a campaign does not set it"}),
    {"bounds", MachineKey::array, "[low, high], null: open"},
    {"above", MachineKey::quantity, "a lower bound that is no value itself, in its unit"},
    {"meaning", MachineKey::text, "in words"},
    {"whole", MachineKey::flag, "true: whole numbers only", "false"},
    {"words", MachineKey::words,
     "it is a word, one of these: \"{NAME}\" in a text is replaced by it, and NAME_is_WORD "
     "is 1 or 0 in expressions"},
    {"file",
     MachineKey::word,
     "it is a file, of sizes, an stl or a packing: \"{NAME}\" where a file is named stands for it; its default is a "
     "word, and so may be others in \"words\"",
     {},
     {},
     file_words},
    {"only_if", MachineKey::object,
     "where it has an effect: by the name of another parameter 0, \"set\" (not 0), a word or a list of words"},
});

constexpr auto follow_keys = std::to_array<Field>({
    {"times", MachineKey::array, "rising times from the start of the run, or from \"from\", s"},
    {"positions", MachineKey::array,
     "where the wall is at each time, a vector from where it is drawn, m; the first is 0"},
    {"angles", MachineKey::array, "or how far it has turned at each time, right hand, rad; the first is 0"},
    {"position", MachineKey::vector, "or three expressions of the time t, m"},
    {"angle", MachineKey::quantity, "or an expression of the time t, rad"},
    {"every", MachineKey::quantity, "with an expression: time from value to value, s"},
    {"until", MachineKey::quantity, "with an expression: the last time, s"},
    {"axis", MachineKey::direction, "of angles"},
    {"through", MachineKey::vector, "of angles: a point on the axis, as of rotate, m", "[0, 0, 0]"},
});

constexpr auto extent_keys = std::to_array<Field>({
    needed({"stl", MachineKey::text, "the file, as of a wall"}),
    {"scale", MachineKey::quantity, "length of the file's unit, m", "1"},
    {"fit", MachineKey::quantity, "as of a wall, m"},
    {"facet_angle", MachineKey::quantity, "as of a wall, rad", "0"},
    needed({"along", MachineKey::direction, "the direction"}),
    {"when", MachineKey::quantity, "0: there is none, and it is 0", "1"},
});

constexpr auto gravity_keys = std::to_array<Field>({
    needed({"size", MachineKey::quantity, "m/s2"}),
    {"tilt", MachineKey::quantity, "angle from -z, rad", "0"},
    {"azimuth", MachineKey::quantity, "direction of the tilt in the xy plane, from x towards y, rad", "0"},
});

constexpr auto domain_keys = std::to_array<Field>({
    {"low", MachineKey::array, "lower corner, m; null along an axis: around the walls"},
    {"high", MachineKey::array, "upper corner, m; null along an axis: around the walls"},
    {"sides", MachineKey::words, "along x, y and z: 'open' or 'periodic'", "[\"open\", \"open\", \"open\"]"},
    {"periodic", MachineKey::vector, "or along x, y and z a value: 0 is open", "[0, 0, 0]"},
});

constexpr std::array material_keys = {
    Field{"density", MachineKey::quantity, "kg/m3; of materials of particles"},
    needed(fields::quantity<&dem::Elasticity::youngs_modulus>("youngs_modulus", "Pa", "", {1e3, 1e13})),
    fields::quantity<&dem::Elasticity::poisson_ratio>("poisson_ratio", "1", "Poisson's ratio", {0, 0.5}),
};

constexpr auto size_keys = std::to_array<Field>({
    {"spread",
     MachineKey::word,
     "monodisperse: all equal; uniform: between (1 - half_width) D and (1 + half_width) D; lognormal: sigma; "
     "weibull_wide, weibull_narrow: five classes; file: as \"file\" says",
     {},
     {},
     spread_words},
    {"half_width", MachineKey::quantity, "of uniform: half of the range divided by D", "0.1"},
    {"sigma", MachineKey::quantity, "of lognormal: standard deviation of ln d", "0.2"},
    {"file", MachineKey::text, "a CSV file with measured sizes, as size_file of the scenes"},
});

constexpr std::array<std::string_view, 2> damping_words = {"contact", "body"};
constexpr auto grain_shape_keys = std::to_array<Field>({
    {"aspect_ratio", MachineKey::quantity,
     "equal spheres in a row along x: length divided by width, 1 to 20; two spheres up to 1.5, else 1 + ceil(2 (A - "
     "1))"},
    {"spheres", MachineKey::value,
     "spheres [[x, y, z, diameter], ...] in any unit, or a CSV file with the header x,y,z,diameter or x,y,z,radius; "
     "with "
     "stl the largest number of spheres"},
    {"stl", MachineKey::text,
     "a closed surface in any unit, which spheres cover; mass and inertia are those of its body"},
    {"error", MachineKey::quantity,
     "of stl: enough spheres where they share all but this part of the volume; default: until a further one of at most "
     "16 would add less than 0.5 %"},
    {"mass", MachineKey::quantity, "kg, of a particle of the diameter; default: density times volume"},
    {"inertia", MachineKey::array,
     "xx, xy, xz, yy, yz, zz about the centre of mass, kg m2, of a particle of the diameter; default: evenly filled"},
    {"centre", MachineKey::vector, "of mass, in the unit of the spheres or the stl; default: evenly filled"},
    {"damping_mass",
     MachineKey::word,
     "mass by which contacts are damped. contact: (1/m + (r x n) I^-1 (r x n))^-1, so that every impact has the "
     "restitution; body: that of the particle, as in LIGGGHTS",
     "\"contact\"",
     {},
     damping_words},
});

constexpr auto species_keys = std::to_array<Field>({
    {"material", MachineKey::text, "one of the materials; default: the only one, or the only one with a density"},
    {"diameter", MachineKey::quantity,
     "m; of unequal sizes the unit D; with a file of sizes their mean by default; of a shape the diameter of the "
     "sphere "
     "of equal volume"},
    holding({"sizes", MachineKey::object, "how diameters are distributed; default: all equal"}, size_keys),
    holding({"shape", MachineKey::object, "a rigid body of spheres; default: a sphere"}, grain_shape_keys),
    {"powder", MachineKey::text,
     "a powder file beside the machine file: gives material, diameter, sizes and contacts as far as the machine does "
     "not"},
});

using machine::Cut;
constexpr std::array packing_keys = {
    needed(fields::quantity<&Cut::edge>("edge", "m", "of the cube, from the origin on", positive_number)),
    fields::quantity<&Cut::fraction>("fraction", "1", "of its volume that spheres fill", {0.05, 0.635}),
    fields::quantity<&Cut::seed>("seed", "1", "which packing; 0: another one for each case", {0, 9.0e15}),
    Field{"file", MachineKey::text,
          "instead: a CSV file with the header x,y,z, centres in diameters; or \"{NAME}\" of a parameter that is one"},
};

using machine::Again;
constexpr std::array again_keys = {
    needed(Field{"each", MachineKey::text, "the phase, which repeats"}),
    fields::vector<&Again::by>("by", "m", "how far it is moved on, each time but the first"),
    Field{"first", MachineKey::quantity, "time of the phase from which on it is there, counted from 0", "0"},
};

using machine::Fill;
constexpr std::array fill_keys = {
    Field{"species", MachineKey::text, "the species; or a mix"},
    Field{"mix", MachineKey::object, "shares by species; only their ratios count: their sum need not be 1"},
    Field{"by", MachineKey::word, "what the shares of a mix are of", "\"mass\"", {}, by_words},
    Field{"count", MachineKey::quantity, "number of particles, rounded"},
    Field{"mass", MachineKey::quantity, "or their mass, kg"},
    Field{"volume", MachineKey::quantity, "or their solid volume, m3"},
    fields::region<&Fill::in>("in", "the region they lie in"),
    fields::choice<&Fill::as>(
        "as",
        "lattice: 1.15 diameters apart, shaken by a twentieth, from the bottom up; random: at random places; rain: "
        "layer above layer at random places, to fall one after the other; packed: cut from a random close packing, "
        "touching; cells: one in each cell of a grid, shaken so that none touch, from the bottom up",
        as_words, "\"lattice\""),
    fields::quantity<&Fill::spacing>("spacing", "1", "of cells: their least width in largest diameters", {1, 10}),
    Field{"exact", MachineKey::flag,
          "true: with mass or volume: particles are drawn until theirs is nearest to it, whatever their number",
          "false"},
    Field{"at", MachineKey::text, "phase at whose beginning it is filled, each time; default: at the start"},
    Field{"counter", MachineKey::text, "with at: name that counts the times in expressions, from 0"},
    fields::flag<&Fill::on_top>("on_top", "true: the region is raised above the particles that lie in it"),
    fields::vector<&Fill::velocity>("velocity", "m/s", ""),
    fields::quantity<&Fill::shaken>("shaken", "m/s", "random velocity in each direction, up to this",
                                    no_negative_number),
    fields::flag<&Fill::glued>("glued", "true: they never move, and are touched as a wall is"),
    Field{"spheres", MachineKey::value,
          "particles one by one: a list, or a CSV file with the header x,y,z and diameter, vx,vy,vz, wx,wy,wz, of a "
          "shape qw,qx,qy,qz, as far as known"},
    holding({"packing", MachineKey::object,
             "spheres of one random close packing of equal ones in a cube: those with their centres in the region"},
            packing_keys),
    Field{
        "tight", MachineKey::quantity,
        "with packing and glued: spheres that no mobile one can touch are left out, as long as no overlap exceeds this "
        "share of a diameter; beyond it the case is not sound"},
    Field{"name", MachineKey::text,
          "with packing: of its observables NAME_particles and NAME_packing, the numbers of spheres in the region and "
          "in the whole packing"},
    Field{"when", MachineKey::quantity, "0: it is left out", "1"},
};

using machine::Removal;
constexpr std::array removal_keys = {
    needed(fields::region<&Removal::in>("in", "the region")),
    fields::choice<&Removal::of>("of", "what of a particle lies in the region: its centre, a part, or the whole",
                                 part_words, "\"centre\""),
    needed({"at", MachineKey::text, "phase at whose beginning they are taken away, each time"}),
    Field{"counter", MachineKey::text, "name that counts the times in expressions, from 0"},
    Field{"when", MachineKey::quantity, "0: it is left out", "1"},
};

constexpr std::array sphere_keys = {
    needed(fields::vector<&dem::Sphere::position>("at", "m", "")),
    Field{"name", MachineKey::text, "by which \"of\" of a measurement selects it alone"},
    Field{"diameter", MachineKey::quantity, "m; default: that of the species"},
    fields::vector<&dem::Sphere::velocity>("velocity", "m/s", ""),
    fields::vector<&dem::Sphere::angular_velocity>("spin", "rad/s", ""),
    Field{"orientation", MachineKey::array, "of a shape: a quaternion w, x, y, z", "[1, 0, 0, 0]"},
};

using machine::Feed;
constexpr std::array feed_keys = {
    Field{"name", MachineKey::text, "of its observables NAME_fed and NAME_waiting", "\"feed\""},
    Field{"species", MachineKey::text, "the species; or a mix"},
    Field{"mix", MachineKey::object, "shares by species; only their ratios count: their sum need not be 1"},
    Field{"by", MachineKey::word, "what the shares of a mix are of", "\"mass\"", {}, by_words},
    needed(fields::quantity<&Feed::rate>("rate", "kg/s", "", no_negative_number)),
    needed({"through", MachineKey::object,
            "the region in which particles appear; or a disc: as thick as one and a half of them"}),
    fields::vector<&Feed::velocity>("velocity", "m/s", ""),
    Field{"every", MachineKey::quantity,
          "time from batch to batch, s; default: until a batch has left the region by its velocity"},
    Field{"during", MachineKey::words, "phases in which it acts; default: all"},
    Field{"when", MachineKey::quantity, "0: it is left out", "1"},
};

constexpr auto start_keys = std::to_array<Field>({
    needed({"phase", MachineKey::text, "the phase with which the start ends"}),
    {"seed", MachineKey::quantity,
     "of its random numbers: a start of one phase is computed once for all cases with the same start and kept beside "
     "the database; 0: that of the case, which shares nothing",
     "0"},
});

constexpr auto check_keys = std::to_array<Field>({
    needed({"when", MachineKey::quantity, "not 0: it is said"}),
    {"refuse", MachineKey::text, "the case is impossible: why; \"{NAME}\" is a number or word"},
    {"warn", MachineKey::text, "the case says little: a name for all cases of this kind"},
    {"that", MachineKey::text, "with warn: why; \"{NAME}\" is a number or word"},
});

using machine::FlowStops;
constexpr std::array flow_stops_keys = {
    needed(fields::region<&FlowStops::region>("in", "the region")),
    needed(fields::quantity<&FlowStops::quiet>("quiet", "s", "", positive_number)),
};

using machine::Quiet;
constexpr std::array quiet_keys = {
    needed(fields::region<&Quiet::region>("in", "the region")),
    needed(fields::quantity<&Quiet::speed>("speed", "m/s", "", positive_number)),
    fields::quantity<&Quiet::share>("share", "1", "of the particles in the region that may move; always one", {0, 1}),
    needed(fields::quantity<&Quiet::time>("for", "s", "", positive_number)),
};

using machine::Known;
constexpr std::array known_keys = {
    needed({"measure", MachineKey::text, "a measurement with a standard error"}),
    needed({"error", MachineKey::quantity,
            "below which it is known: a quantity, or a number in the unit in which it is shown"}),
    fields::quantity<&Known::from>("from", "1", "share of the phase from which on it is looked at", {0, 1}),
    Field{"every", MachineKey::quantity, "frames from look to look: rare ones are no chance", "10"},
};

constexpr auto until_keys = std::to_array<Field>({
    {"at_rest", MachineKey::flag, "kinetic energy below a thousandth of m g d per particle for sqrt(d/g)"},
    {"empty", MachineKey::region, "no particle in a region"},
    holding({"flow_stops", MachineKey::object, "the mass in a region stays the same for a time"}, flow_stops_keys),
    holding({"quiet", MachineKey::object,
             "for a time at most a share of the particles in a region was faster, and their number changed by no more"},
            quiet_keys),
    holding({"known", MachineKey::object,
             "the standard error of a measurement in this phase is below a value, or it has not changed at all"},
            known_keys),
    {"measure", MachineKey::text, "a measurement passes a value, whatever its \"during\": above or below"},
    {"above", MachineKey::quantity, "of measure"},
    {"below", MachineKey::quantity, "of measure"},
});

using machine::Phase;
constexpr std::array phase_keys = {
    Field{"name", MachineKey::text, "by which others name it; needed unless it is a group"},
    Field{"for", MachineKey::quantity, "how long it lasts, s"},
    Field{"until", MachineKey::value, "what ends it; of a list whatever holds first"},
    Field{"at_most", MachineKey::quantity, "with until: how long it lasts at most, s"},
    fields::quantity<&Phase::expected>(
        "expected", "s",
        "with until: how long it will last; changes only predictions of cost, half of at_most by default",
        no_negative_number),
    Field{"frames", MachineKey::quantity, "it is measured at its beginning and after each of so many equal intervals",
          "100"},
    fields::quantity<&Phase::every>("every", "s", "instead of frames: from one to the next, rounded down to steps",
                                    positive_number),
    fields::flag<&Phase::ends_at_frames>("ends_at_frames",
                                         "true: its conditions are looked at when it is measured, and not in between"),
    Field{"phases", MachineKey::array,
          "instead of all others: a group of phases, or of groups, that \"repeat\" repeats"},
    Field{"repeat", MachineKey::quantity, "of a group: so many times, 1 or more"},
    Field{"as", MachineKey::text, "of a group: name that counts them in expressions, from 0"},
};

using machine::Scale;
constexpr std::array scale_keys = {
    fields::quantity<&Scale::value>("value", "1", "values are divided by it; of a time_of the time", positive_number),
    Field{"unit", MachineKey::text, "unit of the values, as shown"},
    fields::quantity<&Scale::time>("time", "s", "times are divided by it", positive_number),
    fields::quantity<&Scale::bin>("bin", "1", "bins are divided by it", positive_number),
    Field{"over", MachineKey::text, "what times or bins are, with their unit, as shown"},
};

using machine::Measure;
constexpr std::array<std::string_view, 3> repeats_words = {"all", "last", "each"};
constexpr auto measure_keys = std::to_array<Field>({
    {"as", MachineKey::word,
     "what becomes of the values at the frames; default: mean, of a profile profile; of what counts all so far last, "
     "last_profile"},
    {"during", MachineKey::words, "phases in which it is measured; default: all"},
    {"shares", MachineKey::array, "only values from the first to the second of these shares of the first value count"},
    {"while", MachineKey::object,
     "by the name of another measurement [low, high], null: open: only values at frames at which it lies there count"},
    {"unless", MachineKey::text,
     "an expression of measurements: where it is not 0, this value and its error are undefined, such as a rate that a "
     "jam cut short"},
    {"repeats",
     MachineKey::word,
     "how phases that repeat count: all together; last: the last time; each: a profile of one value for each time",
     "\"all\"",
     {},
     repeats_words},
    {"error", MachineKey::text, "name of its standard error; default: NAME_error"},
    {"when", MachineKey::quantity, "0: it is left out", "1"},
    fields::flag<&Measure::relative>("relative", "true: values are divided by the first one, of a profile bin by bin"),
    {"every", MachineKey::quantity, "measured at each n-th frame of a phase, and at its last", "1"},
    holding({"scale", MachineKey::object, "units in which it is shown"}, scale_keys),
    {"since", MachineKey::text, "of a series: the phase from whose beginning its times count; default: the start"},
    {"meaning", MachineKey::text, "in words"},
});

constexpr auto time_of_keys = std::to_array<Field>({
    needed({"time_of", MachineKey::text, "a measurement: the first time at which it passes a value, s"}),
    {"above", MachineKey::quantity, "the value"},
    {"below", MachineKey::quantity, "the value"},
    holding({"scale", MachineKey::object, "the unit in which it is shown: value and unit"}, scale_keys),
    {"meaning", MachineKey::text, "in words"},
});

constexpr std::array shaking_keys = {
    needed(fields::vector<&dem::Shaking::amplitude>("amplitude", "m", "of the displacement, a sine")),
    needed(fields::quantity<&dem::Shaking::frequency>("frequency", "Hz", "", no_negative_number)),
};

constexpr std::array glued_keys = {
    fields::quantity<&dem::Surface::restitution>("restitution", "1", "", {0, 1, true, false}),
    fields::quantity<&dem::Surface::friction>("friction", "1", "", {0, 10}),
    fields::quantity<&dem::Surface::rolling_friction>("rolling_friction", "1", "", {0, 1}),
    fields::quantity<&dem::Surface::cohesion>("cohesion", "J/m3", "", {0, 1e9}),
    fields::quantity<&dem::Surface::surface_energy>("surface_energy", "J/m2", "", {0, 100}),
};

constexpr auto expression_keys = std::to_array<Field>({
    needed({"expression", MachineKey::text, "of other measurements, parameters and \"let\""}),
    {"unit", MachineKey::text, "its unit, as shown", "\"SI\""},
    {"meaning", MachineKey::text, "in words"},
});

/// Returns an object for each alternative, followed by other fields.
std::vector<Field> with_alternatives(std::span<const Type> types, std::string_view meaning,
                                     std::initializer_list<Field> others) {
    std::vector<Field> all;
    for (const Type& type : types)
        all.push_back(holding({type.name, MachineKey::object, meaning.empty() ? type.meaning : meaning}, type.fields));
    all.insert(all.end(), others);
    return all;
}

}  // namespace

std::span<const Field> motion() {
    static const auto keys = with_alternatives(
        geometry::motion_types(), {},
        {
            holding({"follow", MachineKey::object, "a table of times, or an expression of the time"}, follow_keys),
            {"from", MachineKey::quantity,
             "a phase, at whose beginning it starts, or a time, s; of follow a time; default: at the start"},
            {"to", MachineKey::quantity, "a phase, at whose end it ends, or a time, s; default: never"},
            {"during", MachineKey::words, "phases in which it acts, one after the other"},
            {"repeat", MachineKey::quantity, "so many of it: a motion that comes again", "1"},
            {"as", MachineKey::text, "name that counts the repeated ones in expressions, from 0"},
            {"when", MachineKey::quantity, "0: it does not act at all", "1"},
        });
    return keys;
}

std::span<const Field> wall() {
    static const auto keys = with_alternatives(
        machine::shape_types(), "a shape",
        {
            {"triangles", MachineKey::array, "a shape: a list of triangles [[x, y, z], [x, y, z], [x, y, z]], m"},
            {"stl", MachineKey::text, "a shape: an STL file beside the machine file"},
            {"scale", MachineKey::quantity, "of stl: length of the file's unit, m", "1"},
            {"fit", MachineKey::quantity,
             "of stl: made so long along y, from y = 0 on, for a domain that is periodic; its lowest points, of these "
             "the "
             "foremost, at the origin, m"},
            {"facet_angle", MachineKey::quantity,
             "of stl and triangles: facets that meet at less than this angle stand for a curved surface, rad", "0"},
            holding({"turned", MachineKey::object,
                     "of stl, triangles, rectangle, perforated, disc, box: turned before it is placed"},
                    machine::placement_fields()),
            {"at", MachineKey::vector, "of the same: where its origin is placed, m", "[0, 0, 0]"},
            {"material", MachineKey::text, "one of the materials; default: the only one that no particles are of"},
            holding({"motion", MachineKey::array, "motions, which add up", "[]"}, motion()),
            {"only", MachineKey::species,
             "the species that it touches; all others pass through it as if it were not there; default: all touch it"},
            {"during", MachineKey::words, "phases in which it is there; default: all"},
            holding({"again", MachineKey::object,
                     "each time that a phase comes again it starts anew where it is drawn, moved on"},
                    again_keys),
            {"scattered", MachineKey::vector,
             "it stands away from its place by a random share of this, another one in each case, m", "[0, 0, 0]"},
            {"when", MachineKey::quantity, "0: it is not there at all", "1"},
            {"repeat", MachineKey::quantity, "so many of them", "1"},
            {"as", MachineKey::text, "name that counts the repeated ones in expressions, from 0"},
        });
    return keys;
}

std::span<const Field> contacts() {
    static const auto keys = [] {
        std::vector<Field> all(dem::contact_fields().begin(), dem::contact_fields().end());
        all.insert(all.end(), dem::law_fields().begin(), dem::law_fields().end());
        all.push_back(holding({"glued", MachineKey::object,
                               "what differs in contacts with glued particles, if all particles are of one material"},
                              glued_keys));
        all.push_back(
            holding({"pairs", MachineKey::named, "\"MATERIAL MATERIAL\": what differs between these two", "{}"},
                    dem::contact_fields()));
        return all;
    }();
    return keys;
}

std::span<const Field> top() {
    static const std::array keys = {
        needed({"name", MachineKey::text, "the name shown everywhere: letters, digits and _"}),
        Field{"summary", MachineKey::text, "what it is, in one line"},
        holding({"parameters", MachineKey::named, "by name: what factors and fixed values of a campaign may set", "{}"},
                parameter_keys),
        Field{"let", MachineKey::object,
              "by name: expressions that other expressions may use; those that use numbers of species are known from "
              "\"walls\" on; or {\"opening\": a level set}: the diameter of the largest disc of it in the lower face "
              "of a cell, m; or {\"extent\": ...}: how far the surface of a file reaches along a direction, m",
              "{}"},
        holding({"checks", MachineKey::array, "what a case is refused for, or warned of", "[]"}, check_keys),
        Field{"gravity", MachineKey::value, "[x, y, z] in m/s2, or size, tilt and azimuth", "[0, 0, -9.81]"},
        holding({"shaking", MachineKey::object, "the machine vibrates as a whole; everything is in its frame"},
                shaking_keys),
        Field{"rest_speed", MachineKey::quantity,
              "m/s: powder slower than this for 256 time steps, and as long as a free fall takes to turn that speed "
              "around, with nothing faster near and no net force of half its weight, is not advanced; only in "
              "precision mixed, without moving walls and shaking",
              "0"},
        Field{
            "impact_speed", MachineKey::quantity,
            "m/s: fastest impact of two particles to be expected, from which the time step follows; default: the fall "
            "through the machine with its fastest wall"},
        holding({"domain", MachineKey::object,
                 "the box outside of which particles are gone; default: around walls, fillings and feeds at all times",
                 "{}"},
                domain_keys),
        needed(holding({"materials", MachineKey::named, "by name: density and stiffness"}, material_keys)),
        holding({"contacts", MachineKey::object, "how bodies of these materials touch", "{}"}, contacts()),
        needed(holding({"species", MachineKey::named, "by name: kinds of particles"}, species_keys)),
        holding({"walls", MachineKey::named, "by name: shape, material, motion", "{}"}, wall()),
        holding({"fill", MachineKey::array, "particles at the start", "[]"}, fill_keys),
        holding({"remove", MachineKey::array, "particles taken away at the beginning of a phase", "[]"}, removal_keys),
        holding({"feed", MachineKey::array, "particles added while it runs", "[]"}, feed_keys),
        needed(holding({"phases", MachineKey::array, "what happens, one after the other"}, phase_keys)),
        holding({"start", MachineKey::object,
                 "the first phases: they are not measured, and behind them contacts with walls begin anew"},
                start_keys),
        needed({"measure", MachineKey::object, "by name: what a case answers"}),
        Field{"accuracy", MachineKey::object,
              "by the words survey, fast, balanced, fine, reference: values of parameters; default: those of every "
              "machine"},
        Field{"main", MachineKey::text,
              "the measurement that reports and tables show first; default: the first by name"},
        Field{"shown", MachineKey::array,
              "what short tables show: a list of {MEASUREMENT: its meaning in a few words}; default: the first six"},
    };
    return keys;
}

constinit const std::span<const Field> parameter = parameter_keys;
constinit const std::span<const Field> extent = extent_keys;
constinit const std::span<const Field> gravity = gravity_keys;
constinit const std::span<const Field> domain = domain_keys;
constinit const std::span<const Field> material = material_keys;
constinit const std::span<const Field> species = species_keys;
constinit const std::span<const Field> sizes = size_keys;
constinit const std::span<const Field> grain_shape = grain_shape_keys;
constinit const std::span<const Field> follow = follow_keys;
constinit const std::span<const Field> fill = fill_keys;
constinit const std::span<const Field> sphere = sphere_keys;
constinit const std::span<const Field> removal = removal_keys;
constinit const std::span<const Field> feed = feed_keys;
constinit const std::span<const Field> phase = phase_keys;
constinit const std::span<const Field> until = until_keys;
constinit const std::span<const Field> known = known_keys;
constinit const std::span<const Field> again = again_keys;
constinit const std::span<const Field> start = start_keys;
constinit const std::span<const Field> check = check_keys;
constinit const std::span<const Field> scale = scale_keys;
constinit const std::span<const Field> measure = measure_keys;
constinit const std::span<const Field> expression = expression_keys;
constinit const std::span<const Field> time_of = time_of_keys;

std::span<const Type> shapes() {
    return machine::shape_types();
}
std::span<const Type> regions() {
    return machine::region_types();
}
std::span<const Type> motions() {
    return geometry::motion_types();
}
std::span<const Type> probes() {
    static const auto types = [] {
        std::vector<Type> all;
        for (const auto& probe : machine::probe_catalogue()) all.push_back({probe.name, probe.meaning, probe.options});
        return all;
    }();
    return types;
}

std::span<const Type> all() {
    static const auto types = [] {
        std::vector<Type> all = {
            {"The file", "", top()},
            {"A parameter", "", parameter_keys},
            {"extent, in let", "", extent_keys},
            {"gravity", "", gravity_keys},
            {"domain", "", domain_keys},
            {"A material", "", material_keys, fields::initial<dem::Elasticity>},
            {"contacts", "", contacts(), []() -> const void* { return &dem::standard_contact(); }},
            {"A species", "", species_keys},
            {"sizes of a species", "", size_keys},
            {"shape of a species", "", grain_shape_keys},
            {"A wall", "", wall()},
            {"again, of a wall", "", again_keys, fields::initial<Again>},
            {"turned, of a wall", "", machine::placement_fields(), fields::initial<machine::Placement>},
            {"A motion of a wall", "", motion()},
        };
        all.insert(all.end(), motions().begin(), motions().end());
        all.push_back({"follow", "", follow_keys});
        const Type others[] = {
            {"A filling", "", fill_keys, fields::initial<Fill>},
            {"packing, of a filling", "", packing_keys, fields::initial<Cut>},
            {"A sphere of a filling", "", sphere_keys, fields::initial<dem::Sphere>},
            {"A removal", "", removal_keys, fields::initial<Removal>},
            {"A feed", "", feed_keys, fields::initial<Feed>},
            {"A phase", "", phase_keys, fields::initial<Phase>},
            {"until, of a phase", "", until_keys},
            {"flow_stops", "", flow_stops_keys},
            {"quiet", "", quiet_keys, fields::initial<Quiet>},
            {"known", "", known_keys, fields::initial<Known>},
            {"start", "", start_keys},
            {"A check", "", check_keys},
            {"A measurement", "", measure_keys},
            {"scale, of a measurement", "", scale_keys, fields::initial<Scale>},
            {"The time of a measurement", "", time_of_keys},
            {"An expression of measurements", "", expression_keys},
            {"shaking", "", shaking_keys},
            {"glued, of contacts", "", glued_keys},
        };
        all.insert(all.end(), std::begin(others), std::end(others));
        return all;
    }();
    return types;
}

}  // namespace grainsweep::campaign::machine_keys
