#include "sweep/campaign/machine_keys.hpp"

#include <array>

namespace grainsweep::campaign::machine_keys {
namespace {

using MachineKey = Key::Kind;

constexpr std::array<std::string_view, 6> spread_words = {"monodisperse", "uniform",        "lognormal",
                                                          "weibull_wide", "weibull_narrow", "file"};
constexpr std::array<std::string_view, 2> file_words = {"sizes", "stl"};
constexpr std::array<std::string_view, 3> by_words = {"count", "mass", "volume"};
constexpr std::array<std::string_view, 4> as_words = {"lattice", "random", "rain", "packed"};
constexpr std::array<std::string_view, 3> rolling_words = {"epsd", "epsd_liggghts", "cdt"};
constexpr std::array<std::string_view, 6> cohesion_words = {"sjkr", "sjkr2", "paper", "jkr", "dmt", "capillary"};
constexpr std::array<std::string_view, 2> normal_words = {"hertz", "linear"};
constexpr std::array<std::string_view, 2> limit_words = {"contact", "net"};
constexpr std::array<std::string_view, 2> tangential_words = {"sum", "spring"};

constexpr auto top_keys = std::to_array<Key>({
    needed({"name", MachineKey::text, "the name shown everywhere: letters, digits and _"}),
    {"summary", MachineKey::text, "what it is, in one line"},
    {"parameters", MachineKey::object, "by name: what factors and fixed values of a campaign may set", "{}"},
    {"let", MachineKey::object,
     "by name: expressions that other expressions may use; those that use numbers of species are known from \"walls\" "
     "on",
     "{}"},
    {"checks", MachineKey::array, "what a case is refused for, or warned of", "[]"},
    {"gravity", MachineKey::value, "[x, y, z] in m/s2, or size, tilt and azimuth", "[0, 0, -9.81]"},
    {"domain", MachineKey::object,
     "the box outside of which particles are gone; default: around walls, fillings and feeds at all times", "{}"},
    needed({"materials", MachineKey::object, "by name: density and stiffness"}),
    {"contacts", MachineKey::object, "how bodies of these materials touch", "{}"},
    needed({"species", MachineKey::object, "by name: kinds of particles"}),
    {"walls", MachineKey::object, "by name: shape, material, motion", "{}"},
    {"fill", MachineKey::array, "particles at the start", "[]"},
    {"feed", MachineKey::array, "particles added while it runs", "[]"},
    needed({"phases", MachineKey::array, "what happens, one after the other"}),
    needed({"measure", MachineKey::object, "by name: what a case answers"}),
    {"main", MachineKey::text, "the measurement that reports and tables show first; default: the first by name"},
});

constexpr auto parameter_keys = std::to_array<Key>({
    {"unit", MachineKey::text,
     "unit of its values; in expressions NAME is the value in SI units and NAME_UNIT the one "
     "in this unit",
     "\"1\""},
    needed({"default", MachineKey::value, "value where a campaign does not set it"}),
    {"bounds", MachineKey::array, "[low, high], null: open"},
    {"above", MachineKey::value, "a lower bound that is no value itself, in its unit"},
    {"meaning", MachineKey::text, "in words"},
    {"whole", MachineKey::flag, "true: whole numbers only", "false"},
    {"words", MachineKey::words,
     "it is a word, one of these: \"{NAME}\" in a text is replaced by it, and NAME_is_WORD "
     "is 1 or 0 in expressions"},
    {"file",
     MachineKey::word,
     "it is a file, of sizes or an stl: \"{NAME}\" where a file is named stands for it; its default is a word",
     {},
     {},
     file_words},
    {"only_if", MachineKey::object,
     "where it has an effect: by the name of another parameter 0, \"set\" (not 0), a word or a list of words"},
});

constexpr auto gravity_keys = std::to_array<Key>({
    needed({"size", MachineKey::value, "m/s2"}),
    {"tilt", MachineKey::value, "angle from -z, rad", "0"},
    {"azimuth", MachineKey::value, "direction of the tilt in the xy plane, from x towards y, rad", "0"},
});

constexpr auto domain_keys = std::to_array<Key>({
    {"low", MachineKey::array, "lower corner, m; null along an axis: around the walls"},
    {"high", MachineKey::array, "upper corner, m; null along an axis: around the walls"},
    {"sides", MachineKey::words, "along x, y and z: 'open' or 'periodic'", "[\"open\", \"open\", \"open\"]"},
    {"periodic", MachineKey::array, "or along x, y and z a value: 0 is open", "[0, 0, 0]"},
});

constexpr auto material_keys = std::to_array<Key>({
    {"density", MachineKey::value, "kg/m3; of materials of particles"},
    needed({"youngs_modulus", MachineKey::value, "Pa"}),
    {"poisson_ratio", MachineKey::value, "Poisson's ratio", "0.3"},
});

constexpr auto contact_keys = std::to_array<Key>({
    {"restitution", MachineKey::value, "coefficient of restitution", "0.5"},
    {"friction", MachineKey::value, "Coulomb friction", "0.5"},
    {"rolling_friction", MachineKey::value, "tangent of the steepest slope a sphere stands on", "0"},
    {"rolling_damping", MachineKey::value, "damping of the rolling spring divided by the critical one", "0.3"},
    {"stiffness", MachineKey::value, "of the linear law, N/m"},
    {"tangential_ratio", MachineKey::value, "of the linear law: stiffness of the tangential spring over the normal one",
     "2/7"},
    {"cohesion", MachineKey::value, "cohesion energy density of sjkr, sjkr2, paper, J/m3", "0"},
    {"surface_energy", MachineKey::value, "work of adhesion of jkr and dmt, J/m2", "0"},
    {"surface_tension", MachineKey::value, "of the liquid of capillary, N/m", "0"},
    {"contact_angle", MachineKey::value, "of the liquid of capillary, rad", "0"},
    {"bridge_volume", MachineKey::value,
     "of capillary: volume of a liquid bridge divided by that of a sphere of the mean radius 2 R1 R2/(R1 + R2), at a "
     "wall of the sphere",
     "0.0002"},
    {"rolling_law", MachineKey::word, "how rolling is resisted", "\"epsd\"", {}, rolling_words},
    {"cohesion_law", MachineKey::word, "how bodies attract each other", "\"sjkr\"", {}, cohesion_words},
    {"friction_limit",
     MachineKey::word,
     "contact: friction of the contact force without cohesion; net: of the net force",
     "\"contact\"",
     {},
     limit_words},
    {"tangential_limit",
     MachineKey::word,
     "sum: friction limits the sum of tangential spring and dashpot; spring: the spring alone, as in LIGGGHTS",
     "\"sum\"",
     {},
     tangential_words},
    {"normal_law",
     MachineKey::word,
     "hertz; linear: spring and dashpot of a given stiffness",
     "\"hertz\"",
     {},
     normal_words},
    {"pairs", MachineKey::object, "\"MATERIAL MATERIAL\": what differs between these two", "{}"},
});

constexpr auto species_keys = std::to_array<Key>({
    {"material", MachineKey::text, "one of the materials; default: the only one, or the only one with a density"},
    {"diameter", MachineKey::value, "m; of unequal sizes the unit D; with a file of sizes their mean by default"},
    {"sizes", MachineKey::object, "how diameters are distributed; default: all equal"},
    {"powder", MachineKey::text,
     "a powder file beside the machine file: gives material, diameter, sizes and contacts as far as the machine does "
     "not"},
});

constexpr auto size_keys = std::to_array<Key>({
    {"spread",
     MachineKey::word,
     "monodisperse: all equal; uniform: between (1 - half_width) D and (1 + half_width) D; lognormal: sigma; "
     "weibull_wide, weibull_narrow: five classes; file: as \"file\" says",
     {},
     {},
     spread_words},
    {"half_width", MachineKey::value, "of uniform: half of the range divided by D", "0.1"},
    {"sigma", MachineKey::value, "of lognormal: standard deviation of ln d", "0.2"},
    {"file", MachineKey::text, "a CSV file with measured sizes, as size_file of the scenes"},
});

constexpr auto wall_keys = std::to_array<Key>({
    {"plane", MachineKey::object, "a shape"},
    {"rectangle", MachineKey::object, "a shape"},
    {"disc", MachineKey::object, "a shape"},
    {"box", MachineKey::object, "a shape"},
    {"cylinder", MachineKey::object, "a shape"},
    {"cone", MachineKey::object, "a shape"},
    {"tube", MachineKey::object, "a shape"},
    {"bar", MachineKey::object, "a shape"},
    {"triangles", MachineKey::array, "a shape: a list of triangles [[x, y, z], [x, y, z], [x, y, z]], m"},
    {"stl", MachineKey::text, "a shape: an STL file beside the machine file"},
    {"scale", MachineKey::value, "of stl: length of the file's unit, m", "1"},
    {"facet_angle", MachineKey::value,
     "of stl and triangles: facets that meet at less than this angle stand for a curved surface, rad", "0"},
    {"turned", MachineKey::object, "of stl, triangles, rectangle, disc, box: turned before it is placed"},
    {"at", MachineKey::array, "of the same: where its origin is placed, m", "[0, 0, 0]"},
    {"material", MachineKey::text, "one of the materials; default: the only one that no particles are of"},
    {"motion", MachineKey::array, "motions, which add up", "[]"},
    {"during", MachineKey::words, "phases in which it is there; default: all"},
    {"when", MachineKey::value, "0: it is not there at all", "1"},
    {"repeat", MachineKey::value, "so many of them", "1"},
    {"as", MachineKey::text, "name that counts the repeated ones in expressions, from 0"},
});

constexpr auto turned_keys = std::to_array<Key>({
    needed({"axis", MachineKey::array, "direction"}),
    needed({"angle", MachineKey::value, "right hand, rad"}),
    {"through", MachineKey::array, "a point on the axis, m", "[0, 0, 0]"},
});

constexpr auto fill_keys = std::to_array<Key>({
    {"species", MachineKey::text, "the species; or a mix"},
    {"mix", MachineKey::object, "shares by species"},
    {"by", MachineKey::word, "what the shares of a mix are of", "\"mass\"", {}, by_words},
    {"count", MachineKey::value, "number of particles, rounded"},
    {"mass", MachineKey::value, "or their mass, kg"},
    {"volume", MachineKey::value, "or their solid volume, m3"},
    {"in", MachineKey::object, "the region they lie in"},
    {"as",
     MachineKey::word,
     "lattice: 1.15 diameters apart, shaken by a twentieth, from the bottom up; random: at random places; rain: layer "
     "above layer at random places, to fall one after the other; packed: cut from a random close packing, touching",
     "\"lattice\"",
     {},
     as_words},
    {"velocity", MachineKey::array, "m/s", "[0, 0, 0]"},
    {"shaken", MachineKey::value, "random velocity in each direction, up to so many m/s", "0"},
    {"glued", MachineKey::flag, "true: they never move, and are touched as a wall is", "false"},
    {"spheres", MachineKey::value,
     "spheres one by one: a list, or a CSV file with the header x,y,z and diameter, vx,vy,vz, wx,wy,wz as far as "
     "known"},
    {"when", MachineKey::value, "0: it is left out", "1"},
});

constexpr auto sphere_keys = std::to_array<Key>({
    needed({"at", MachineKey::array, "m"}),
    {"diameter", MachineKey::value, "m; default: that of the species"},
    {"velocity", MachineKey::array, "m/s", "[0, 0, 0]"},
    {"spin", MachineKey::array, "rad/s", "[0, 0, 0]"},
});

constexpr auto feed_keys = std::to_array<Key>({
    {"name", MachineKey::text, "of its observables NAME_fed and NAME_waiting", "\"feed\""},
    {"species", MachineKey::text, "the species; or a mix"},
    {"mix", MachineKey::object, "shares by species"},
    {"by", MachineKey::word, "what the shares of a mix are of", "\"mass\"", {}, by_words},
    needed({"rate", MachineKey::value, "kg/s"}),
    needed({"through", MachineKey::object,
            "the region in which particles appear; or a disc: as thick as one and a half of them"}),
    {"velocity", MachineKey::array, "m/s", "[0, 0, 0]"},
    {"every", MachineKey::value,
     "time from batch to batch, s; default: until a batch has left the region by its velocity"},
    {"during", MachineKey::words, "phases in which it acts; default: all"},
    {"when", MachineKey::value, "0: it is left out", "1"},
});

constexpr auto phase_keys = std::to_array<Key>({
    needed({"name", MachineKey::text, "by which others name it"}),
    {"for", MachineKey::value, "how long it lasts, s"},
    {"until", MachineKey::value, "what ends it; of a list whatever holds first"},
    {"at_most", MachineKey::value, "with until: how long it lasts at most, s"},
    {"expected", MachineKey::value,
     "with until: how long it will last, s; changes only predictions of cost, half of at_most by default"},
    {"frames", MachineKey::value, "it is measured at its beginning and after each of so many equal intervals", "100"},
    {"ends_at_frames", MachineKey::flag, "true: its conditions are looked at when it is measured, and not in between",
     "false"},
});

constexpr auto until_keys = std::to_array<Key>({
    {"at_rest", MachineKey::flag, "kinetic energy below a thousandth of m g d per particle for sqrt(d/g)"},
    {"empty", MachineKey::object, "no particle in a region"},
    {"flow_stops", MachineKey::object, "the mass in a region stays the same for a time"},
    {"measure", MachineKey::text, "a measurement passes a value: above or below"},
    {"above", MachineKey::value, "of measure"},
    {"below", MachineKey::value, "of measure"},
});

constexpr auto check_keys = std::to_array<Key>({
    needed({"when", MachineKey::value, "not 0: it is said"}),
    {"refuse", MachineKey::text, "the case is impossible: why; \"{NAME}\" is a number or word"},
    {"warn", MachineKey::text, "the case says little: a name for all cases of this kind"},
    {"that", MachineKey::text, "with warn: why; \"{NAME}\" is a number or word"},
});

constexpr auto flow_stops_keys = std::to_array<Key>({
    needed({"in", MachineKey::object, "the region"}),
    needed({"quiet", MachineKey::value, "s"}),
});

constexpr auto measure_keys = std::to_array<Key>({
    {"as", MachineKey::word, "what becomes of the values at the frames; default: mean, of a profile profile"},
    {"during", MachineKey::words, "phases in which it is measured; default: all"},
    {"shares", MachineKey::array, "only values from the first to the second of these shares of the first value count"},
    {"while", MachineKey::object,
     "by the name of another measurement [low, high], null: open: only values at frames at which it lies there count"},
    {"since", MachineKey::text, "of a series: the phase from whose beginning its times count; default: the start"},
    {"meaning", MachineKey::text, "in words"},
});

constexpr auto time_of_keys = std::to_array<Key>({
    needed({"time_of", MachineKey::text, "a measurement: the first time at which it passes a value, s"}),
    {"above", MachineKey::value, "the value"},
    {"below", MachineKey::value, "the value"},
    {"meaning", MachineKey::text, "in words"},
});

constexpr auto expression_keys = std::to_array<Key>({
    needed({"expression", MachineKey::text, "of other measurements, parameters and \"let\""}),
    {"unit", MachineKey::text, "its unit, as shown", "\"SI\""},
    {"meaning", MachineKey::text, "in words"},
});

}  // namespace

std::span<const Key> top() {
    return top_keys;
}
std::span<const Key> parameter() {
    return parameter_keys;
}
std::span<const Key> gravity() {
    return gravity_keys;
}
std::span<const Key> domain() {
    return domain_keys;
}
std::span<const Key> material() {
    return material_keys;
}
std::span<const Key> contacts() {
    return contact_keys;
}
/// Contacts without the laws, which are one for all pairs.
std::span<const Key> pair() {
    return std::span(contact_keys).first<11>();
}
std::span<const Key> species() {
    return species_keys;
}
std::span<const Key> sizes() {
    return size_keys;
}
std::span<const Key> wall() {
    return wall_keys;
}
std::span<const Key> turned() {
    return turned_keys;
}
std::span<const Key> fill() {
    return fill_keys;
}
std::span<const Key> sphere() {
    return sphere_keys;
}
std::span<const Key> feed() {
    return feed_keys;
}
std::span<const Key> phase() {
    return phase_keys;
}
std::span<const Key> until() {
    return until_keys;
}
std::span<const Key> check() {
    return check_keys;
}
std::span<const Key> flow_stops() {
    return flow_stops_keys;
}
std::span<const Key> measure() {
    return measure_keys;
}
std::span<const Key> expression() {
    return expression_keys;
}
std::span<const Key> time_of() {
    return time_of_keys;
}

std::span<const Table> all() {
    static const std::array tables = {
        Table{"The file", top_keys},
        Table{"A parameter", parameter_keys},
        Table{"gravity", gravity_keys},
        Table{"domain", domain_keys},
        Table{"A material", material_keys},
        Table{"contacts", contact_keys},
        Table{"A species", species_keys},
        Table{"sizes of a species", size_keys},
        Table{"A wall", wall_keys},
        Table{"turned, of a wall", turned_keys},
        Table{"A motion of a wall", motion()},
        Table{"rotate", rotate()},
        Table{"shift", shift()},
        Table{"vibrate", vibrate()},
        Table{"press", press()},
        Table{"drive", drive()},
        Table{"free", free()},
        Table{"A filling", fill_keys},
        Table{"A sphere of a filling", sphere_keys},
        Table{"A feed", feed_keys},
        Table{"A phase", phase_keys},
        Table{"until, of a phase", until_keys},
        Table{"flow_stops", flow_stops_keys},
        Table{"A check", check_keys},
        Table{"A measurement", measure_keys},
        Table{"The time of a measurement", time_of_keys},
        Table{"An expression of measurements", expression_keys},
    };
    return tables;
}

}  // namespace grainsweep::campaign::machine_keys
