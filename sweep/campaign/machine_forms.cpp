// Shapes, regions and motions of a machine file.
#include "sweep/campaign/machine_keys.hpp"

#include <array>

namespace grainsweep::campaign::machine_keys {
namespace {

using FormKey = Key::Kind;

constexpr std::array<std::string_view, 2> side_words = {"inside", "outside"};

constexpr auto plane_keys = std::to_array<Key>({
    {"point", FormKey::array, "on it, m", "[0, 0, 0]"},
    needed({"normal", FormKey::array, "direction, to the side of the particles"}),
});
constexpr auto rectangle_keys = std::to_array<Key>({
    needed({"corner", FormKey::array, "m"}),
    needed({"along", FormKey::array, "one side, m"}),
    needed({"across", FormKey::array, "the other side, m"}),
});
constexpr auto disc_keys = std::to_array<Key>({
    {"centre", FormKey::array, "m", "[0, 0, 0]"},
    {"normal", FormKey::array, "direction across it", "[0, 0, 1]"},
    needed({"radius", FormKey::value, "m"}),
    {"inner", FormKey::value, "radius of a hole in the middle, m", "0"},
});
constexpr auto box_keys = std::to_array<Key>({
    needed({"low", FormKey::array, "lower corner, m"}),
    needed({"high", FormKey::array, "upper corner, m"}),
    {"open", FormKey::words, "of walls: faces that are left out, '-x', '+x', '-y', '+y', '-z', '+z'", "[]"},
});
constexpr auto region_box_keys = std::to_array<Key>({
    needed({"low", FormKey::array, "lower corner, m"}),
    needed({"high", FormKey::array, "upper corner, m"}),
});
constexpr auto cylinder_keys = std::to_array<Key>({
    {"point", FormKey::array, "on the axis; of one with a length its middle, m", "[0, 0, 0]"},
    {"axis", FormKey::array, "direction", "[0, 0, 1]"},
    needed({"radius", FormKey::value, "m"}),
    {"length", FormKey::value, "m; default: without end"},
    {"side", FormKey::word, "where the particles are", "\"inside\"", {}, side_words},
});
constexpr auto cone_keys = std::to_array<Key>({
    needed({"base", FormKey::array, "centre of the first end, m"}),
    {"axis", FormKey::array, "direction to the second end", "[0, 0, 1]"},
    needed({"base_radius", FormKey::value, "at the first end, m"}),
    needed({"end_radius", FormKey::value, "at the second end, m"}),
    needed({"length", FormKey::value, "m"}),
    {"side", FormKey::word, "where the particles are", "\"inside\"", {}, side_words},
});
constexpr auto tube_keys = std::to_array<Key>({
    needed({"base", FormKey::array, "centre of the first end, m"}),
    {"axis", FormKey::array, "direction to the second end", "[0, 0, 1]"},
    needed({"inner", FormKey::value, "inner radius, m"}),
    needed({"outer", FormKey::value, "outer radius, m"}),
    needed({"length", FormKey::value, "m"}),
});
constexpr auto bar_keys = std::to_array<Key>({
    needed({"front", FormKey::value, "largest x, m"}),
    needed({"thickness", FormKey::value, "along x, m"}),
    needed({"bottom", FormKey::value, "lowest z, m"}),
    needed({"top", FormKey::value, "highest z, m"}),
    {"edge_radius", FormKey::value, "of the two lower edges, m", "0"},
});
constexpr auto round_keys = std::to_array<Key>({
    needed({"base", FormKey::array, "centre of the first end, m"}),
    {"axis", FormKey::array, "direction to the second end", "[0, 0, 1]"},
    needed({"radius", FormKey::value, "m"}),
    {"inner", FormKey::value, "radius of a hollow, m", "0"},
    needed({"length", FormKey::value, "m"}),
});
constexpr auto ball_keys = std::to_array<Key>({
    needed({"centre", FormKey::array, "m"}),
    needed({"radius", FormKey::value, "m"}),
});
constexpr auto half_keys = std::to_array<Key>({
    {"point", FormKey::array, "on the plane, m", "[0, 0, 0]"},
    needed({"normal", FormKey::array, "direction, into the region"}),
});

constexpr std::array shape_forms = {
    Form{"plane", "an infinite plane", plane_keys},
    Form{"rectangle", "a parallelogram, two sides from a corner", rectangle_keys},
    Form{"disc", "a flat disc or ring of 64 facets", disc_keys},
    Form{"box", "the faces of a box", box_keys},
    Form{"cylinder", "a drum from inside, a roller from outside", cylinder_keys},
    Form{"cone", "a funnel from inside, a solid from outside", cone_keys},
    Form{"tube", "the wall between two cylinders, with flat ends", tube_keys},
    Form{"bar", "a bar without end along y, its lower edges rounded", bar_keys},
};
constexpr std::array region_forms = {
    Form{"box", "a box", region_box_keys},
    Form{"cylinder", "a cylinder, hollow or not", round_keys},
    Form{"ball", "a ball", ball_keys},
    Form{"half_space", "one side of a plane", half_keys},
    Form{"all", "a list of regions: where all of them are", {}},
    Form{"any", "a list of regions: where one of them is", {}},
    Form{"not", "a region: outside of it", {}},
};

constexpr auto motion_keys = std::to_array<Key>({
    {"rotate", FormKey::object, "about an axis"},
    {"shift", FormKey::object, "at a velocity"},
    {"vibrate", FormKey::object, "to and fro"},
    {"press", FormKey::object, "a force acts, and the powder resists"},
    {"drive", FormKey::object, "a torque acts, and the powder resists"},
    {"free", FormKey::object, "its weight acts, and the powder resists: it falls, floats and turns as it must"},
    {"from", FormKey::value, "a phase, at whose beginning it starts, or a time, s; default: at the start"},
    {"to", FormKey::value, "a phase, at whose end it ends, or a time, s; default: never"},
    {"during", FormKey::words, "phases in which it acts, one after the other"},
    {"repeat", FormKey::value, "so many of it: a motion that comes again", "1"},
    {"as", FormKey::text, "name that counts the repeated ones in expressions, from 0"},
    {"when", FormKey::value, "0: it does not act at all", "1"},
});

constexpr auto rotate_keys = std::to_array<Key>({
    needed({"axis", FormKey::array, "direction"}),
    {"through", FormKey::array, "a point on the axis, m", "[0, 0, 0]"},
    needed({"speed", FormKey::value, "right hand, rad/s"}),
});

constexpr auto shift_keys = std::to_array<Key>({
    needed({"velocity", FormKey::array, "m/s"}),
});

constexpr auto press_keys = std::to_array<Key>({
    needed({"along", FormKey::array, "direction of the force, the only one in which the wall can move"}),
    needed({"force", FormKey::value, "that acts on the wall, with its weight, N"}),
    needed({"mass", FormKey::value, "of the wall, kg"}),
    needed({"speed_at_most", FormKey::value, "it never moves faster, m/s; the time step follows from it"}),
});

constexpr auto drive_keys = std::to_array<Key>({
    needed({"axis", FormKey::array, "direction"}),
    {"through", FormKey::array, "a point on the axis, m", "[0, 0, 0]"},
    needed({"torque", FormKey::value, "that acts on the wall, right hand, N m"}),
    needed({"inertia", FormKey::value, "moment of inertia of the wall about the axis, kg m2"}),
    needed({"speed_at_most", FormKey::value, "it never turns faster, rad/s; the time step follows from it"}),
});

constexpr auto free_keys = std::to_array<Key>({
    needed({"mass", FormKey::value, "of the wall, kg; its weight acts on it"}),
    {"centre", FormKey::array, "of mass, m; default: of an evenly filled mesh"},
    {"inertia", FormKey::array,
     "moments of inertia about the centre, along x, y and z, kg m2; default: of an evenly filled mesh"},
    {"held", FormKey::array, "along x, y and z a value: not 0 holds its centre along this axis", "[0, 0, 0]"},
    {"force", FormKey::array, "that acts on the centre besides the weight, N", "[0, 0, 0]"},
    {"torque", FormKey::array, "that acts on the wall, N m", "[0, 0, 0]"},
    needed({"speed_at_most", FormKey::value,
            "its centre never moves faster, nor its farthest corner by turning, m/s; the time step follows from it"}),
});

constexpr auto vibrate_keys = std::to_array<Key>({
    needed({"amplitude", FormKey::array, "m"}),
    needed({"frequency", FormKey::value, "Hz"}),
    {"phase", FormKey::value, "rad", "0"},
});

}  // namespace

std::span<const Key> motion() {
    return motion_keys;
}
std::span<const Key> rotate() {
    return rotate_keys;
}
std::span<const Key> shift() {
    return shift_keys;
}
std::span<const Key> press() {
    return press_keys;
}
std::span<const Key> drive() {
    return drive_keys;
}
std::span<const Key> free() {
    return free_keys;
}
std::span<const Key> vibrate() {
    return vibrate_keys;
}
std::span<const Form> shapes() {
    return shape_forms;
}
std::span<const Form> regions() {
    return region_forms;
}

}  // namespace grainsweep::campaign::machine_keys
