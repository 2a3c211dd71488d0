#include "solver/machine/shapes.hpp"

#include "solver/geometry/motion.hpp"
#include "solver/geometry/stl.hpp"
#include "solver/geometry/weld.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::machine {

using geometry::cross;
using geometry::norm;
using geometry::Vec3;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;

namespace {

constexpr int facets = 64;

constexpr std::array<std::string_view, 2> side_words = {"inside", "outside"};
constexpr std::array<std::string_view, 6> face_words = {"-x", "+x", "-y", "+y", "-z", "+z"};

constexpr std::array plane_fields = {
    fields::vector<&geometry::Plane::point>("point", "m", "on it"),
    needed(fields::direction<&geometry::Plane::normal>("normal", "direction, to the side of the particles")),
};
constexpr std::array rectangle_fields = {
    needed(fields::vector<&Rectangle::corner>("corner", "m", "")),
    needed(fields::vector<&Rectangle::along>("along", "m", "one side")),
    needed(fields::vector<&Rectangle::across>("across", "m", "the other side")),
};
constexpr std::array<std::string_view, 2> pattern_words = {"square", "triangular"};
constexpr std::array perforated_fields = {
    needed(fields::vector<&Perforated::corner>("corner", "m", "")),
    needed(fields::vector<&Perforated::along>("along", "m", "one side, along which the rows run")),
    needed(fields::vector<&Perforated::across>("across", "m", "the other side, at a right angle")),
    needed(fields::quantity<&Perforated::hole>("hole", "m", "diameter of the holes", positive_number)),
    needed(fields::quantity<&Perforated::pitch>("pitch", "m", "between the centres of neighbours", positive_number)),
    fields::choice<&Perforated::pattern>("pattern", "triangular: every second row is shifted by half a pitch",
                                         pattern_words, "\"square\""),
};
constexpr std::array disc_fields = {
    fields::vector<&Disc::centre>("centre", "m", ""),
    fields::direction<&Disc::normal>("normal", "direction across it"),
    needed(fields::quantity<&Disc::radius>("radius", "m", "", positive_number)),
    fields::quantity<&Disc::inner>("inner", "m", "radius of a hole in the middle", no_negative_number),
};
/// Opens one face.
constexpr Field open_field = [] {
    Field field{"open", Field::Kind::words, "of walls: faces that are left out", "[]", {}, face_words};
    field.choose = [](void* object, std::size_t face) { static_cast<Box*>(object)->open[face] = true; };
    return field;
}();
constexpr std::array box_fields = {
    needed(fields::vector<&Box::low>("low", "m", "lower corner")),
    needed(fields::vector<&Box::high>("high", "m", "upper corner")),
    open_field,
};
using geometry::Cylinder;
constexpr std::array cylinder_fields = {
    fields::vector<&Cylinder::point>("point", "m", "on the axis; of one with a length its middle"),
    fields::direction<&Cylinder::axis>("axis", "direction"),
    needed(fields::quantity<&Cylinder::radius>("radius", "m", "")),
    fields::quantity<&Cylinder::length>("length", "m", "default: without end", positive_number),
    fields::choice<&Cylinder::side>("side", "where the particles are", side_words, "\"inside\""),
};
using geometry::Cone;
constexpr std::array cone_fields = {
    needed(fields::vector<&Cone::base>("base", "m", "centre of the first end")),
    fields::direction<&Cone::axis>("axis", "direction to the second end"),
    needed(fields::quantity<&Cone::base_radius>("base_radius", "m", "at the first end")),
    needed(fields::quantity<&Cone::end_radius>("end_radius", "m", "at the second end")),
    needed(fields::quantity<&Cone::length>("length", "m", "")),
    fields::choice<&Cone::side>("side", "where the particles are", side_words, "\"inside\""),
};
using geometry::Tube;
constexpr std::array tube_fields = {
    needed(fields::vector<&Tube::base>("base", "m", "centre of the first end")),
    fields::direction<&Tube::axis>("axis", "direction to the second end"),
    needed(fields::quantity<&Tube::inner>("inner", "m", "inner radius")),
    needed(fields::quantity<&Tube::outer>("outer", "m", "outer radius")),
    needed(fields::quantity<&Tube::length>("length", "m", "")),
};
using geometry::Bar;
constexpr std::array bar_fields = {
    needed(fields::quantity<&Bar::front>("front", "m", "largest x")),
    needed(fields::quantity<&Bar::thickness>("thickness", "m", "along x")),
    needed(fields::quantity<&Bar::bottom>("bottom", "m", "lowest z")),
    needed(fields::quantity<&Bar::top>("top", "m", "highest z")),
    fields::quantity<&Bar::edge_radius>("edge_radius", "m", "of the two lower edges"),
};
constexpr std::array shape_rows = {
    fields::alternative<StatedShape, geometry::Plane>("plane", "an infinite plane", plane_fields),
    fields::alternative<StatedShape, Rectangle>("rectangle", "a parallelogram, two sides from a corner",
                                                rectangle_fields),
    fields::alternative<StatedShape, Perforated>(
        "perforated", "a flat plate with round holes in rows, as many as fit; it has no thickness", perforated_fields),
    fields::alternative<StatedShape, Disc>("disc", "a flat disc or ring of 64 facets", disc_fields),
    fields::alternative<StatedShape, Box>("box", "the faces of a box", box_fields),
    fields::alternative<StatedShape, Cylinder>(
        "cylinder", "a drum from inside, or with a length a bore in a plate without end; a roller from outside",
        cylinder_fields),
    fields::alternative<StatedShape, Cone>("cone", "from inside a funnel in a plate without end, from outside a solid",
                                           cone_fields),
    fields::alternative<StatedShape, Tube>(
        "tube", "the wall between two cylinders, with flat ends: grains on both sides", tube_fields),
    fields::alternative<StatedShape, Bar>("bar", "a bar without end along y, its lower edges rounded", bar_fields),
};

constexpr std::array placement_rows = {
    needed(fields::direction<&Placement::axis>("axis", "direction")),
    needed(fields::quantity<&Placement::angle>("angle", "rad", "right hand")),
    fields::vector<&Placement::through>("through", "m", "a point on the axis"),
};

geometry::Pose pose_of(const Placement& placement) {
    const std::array<geometry::Motion, 1> turn = {
        geometry::Rotation{.point = placement.through, .axis = placement.axis, .speed = placement.angle}};
    geometry::Pose pose;
    if (placement.angle != 0) pose = geometry::pose_at(turn, 1);
    pose.shift = pose.shift + placement.at;
    return pose;
}

}  // namespace

std::span<const Type> shape_types() {
    return shape_rows;
}

std::span<const Field> placement_fields() {
    return placement_rows;
}

Triangles triangles_of(const Rectangle& rectangle) {
    const auto& [corner, along, across] = rectangle;
    const Vec3 b = corner + along, c = corner + along + across, d = corner + across;
    return {{corner, b, c}, {corner, c, d}};
}

Triangles triangles_of(const Disc& disc) {
    const auto& [centre, normal, radius, inner] = disc;
    if (!(inner < radius)) throw std::invalid_argument("the inner radius of a disc must be less than its radius");
    const Vec3 across = std::abs(normal[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = (1 / norm(cross(normal, across))) * cross(normal, across);
    const Vec3 v = cross(normal, u);
    // A polygon of this radius has the area of the circle.
    const double angle = 2 * std::numbers::pi / facets, wider = std::sqrt(angle / std::sin(angle));
    const auto corner = [angle, wider, u, v, &disc](double r, int k) {
        return disc.centre + wider * r * std::cos(angle * k) * u + wider * r * std::sin(angle * k) * v;
    };
    Triangles triangles;
    for (int k = 0; k < facets; ++k) {
        const int next = (k + 1) % facets;
        if (inner > 0) {
            triangles.push_back({corner(inner, k), corner(radius, k), corner(radius, next)});
            triangles.push_back({corner(inner, k), corner(radius, next), corner(inner, next)});
        } else {
            triangles.push_back({centre, corner(radius, k), corner(radius, next)});
        }
    }
    return triangles;
}

Triangles triangles_of(const Box& box) {
    const auto& [low, high, open] = box;
    for (std::size_t k = 0; k < 3; ++k)
        if (!(low[k] < high[k]))
            throw std::invalid_argument("\"low\" of a box must lie below \"high\" along every axis");
    Triangles all;
    const Vec3 size = high - low;
    for (std::size_t k = 0; k < 3; ++k) {
        Vec3 along{}, across{}, up{};
        along[(k + 1) % 3] = size[(k + 1) % 3];
        across[(k + 2) % 3] = size[(k + 2) % 3];
        up[k] = size[k];
        for (const bool upper : {false, true}) {
            if (open[2 * k + (upper ? 1 : 0)]) continue;
            for (const auto& triangle : triangles_of(Rectangle{upper ? low + up : low, along, across}))
                all.push_back(triangle);
        }
    }
    return all;
}

geometry::Mesh mesh_of(Triangles triangles, double facet_angle, const Placement& placement) {
    if (triangles.empty()) throw std::invalid_argument("it has no triangle");
    const auto pose = pose_of(placement);
    for (auto& triangle : triangles)
        for (Vec3& corner : triangle) {
            corner = pose.from_body(corner);
            if (!geometry::finite(corner)) throw std::invalid_argument("a corner is no number");
        }
    auto surface = geometry::weld(triangles).surface;
    if (surface.triangles.empty()) throw std::invalid_argument("its triangles have no area");
    return geometry::Mesh(std::move(surface), facet_angle);
}

geometry::Mesh stl_mesh(std::string_view contents, double scale, double facet_angle, const Placement& placement) {
    auto surface = geometry::read_stl(contents, scale).surface;
    const auto pose = pose_of(placement);
    for (Vec3& corner : surface.corners) corner = pose.from_body(corner);
    return geometry::Mesh(std::move(surface), facet_angle);
}

std::optional<geometry::Solid> solid_of(const geometry::Shape& shape) {
    const auto* mesh = std::get_if<geometry::Mesh>(&shape);
    return mesh != nullptr ? geometry::solid_of(mesh->surface()) : std::nullopt;
}

}  // namespace grainsweep::machine
