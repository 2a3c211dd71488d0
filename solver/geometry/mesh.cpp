#include "solver/geometry/mesh.hpp"

#include "solver/geometry/weld.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

namespace grainsweep::geometry {
namespace {

MeshContact contact_with(const Triangle& t, std::uint32_t number, const Vec3& x) {
    const Nearest nearest = t.nearest(x);
    // A face's own normal is exact however near the centre is, and so is that of a centre on the surface.
    const Vec3 of_plane = t.height(x) >= 0 ? t.normal : -t.normal;
    const bool on_face = nearest.feature == Feature::face || nearest.distance <= 0;
    return {on_face ? of_plane : (1 / nearest.distance) * (x - nearest.point), nearest.distance, nearest.point,
            nearest.feature, number};
}

bool within(const Vec3& a, const Vec3& b, double distance) {
    const Vec3 apart = a - b;
    return dot(apart, apart) <= distance * distance;
}

/// The one face among nearest points, if all others lie on it: the only contact by steps 2 and 3. Nearly always.
std::optional<std::size_t> only_face(std::span<const Triangle> triangles, double tolerance,
                                     std::span<const MeshContact> touched) {
    std::optional<std::size_t> face;
    for (std::size_t k = 0; k < touched.size(); ++k) {
        if (touched[k].feature != Feature::face) continue;
        if (face) return std::nullopt;
        face = k;
    }
    if (!face) return std::nullopt;
    const Triangle& t = triangles[touched[*face].triangle];
    for (std::size_t k = 0; k < touched.size(); ++k)
        if (k != *face && !(t.nearest(touched[k].point).distance <= tolerance)) return std::nullopt;
    return face;
}

/// Returns the triangle below a centre if the nearest point of every other triangle within the reach lies on a side
/// shared with it. It is then the only contact, by steps 2 and 3. Uses only planes. Empty: the general search is
/// needed.
std::optional<std::uint32_t> face_beside_sides(std::span<const Triangle> triangles, const auto& prisms,
                                               double tolerance, const Vec3& x, double reach,
                                               std::span<const std::uint32_t> of) {
    const double rounding = 1e-3 * tolerance;
    std::optional<std::uint32_t> face;
    for (const std::uint32_t t : of) {
        if (t >= prisms.size()) return std::nullopt;  // not prepared
        const auto h = prisms[t].heights(x);
        if (!(std::max({h[0], h[1], h[2]}) < -tolerance)) continue;
        if (face || !(std::abs(h[3]) < reach)) return std::nullopt;
        face = t;
    }
    if (!face) return std::nullopt;
    for (const std::uint32_t t : of) {
        if (t == *face) continue;
        const auto h = prisms[t].heights(x);
        const auto side = static_cast<std::size_t>(std::max_element(h.begin(), h.begin() + 3) - h.begin());
        if (!(h[side] > tolerance)) return std::nullopt;
        const Vec3 &from = triangles[t].corner[side], along = triangles[t].corner[(side + 1) % 3] - from;
        const double share = dot(x - from, along) / dot(along, along);
        if (!(share >= 0 && share <= 1)) return std::nullopt;
        const auto on_face = prisms[*face].heights(from + share * along);
        if (!(std::max({on_face[0], on_face[1], on_face[2], std::abs(on_face[3])}) <= rounding)) return std::nullopt;
    }
    return face;
}

}  // namespace

Mesh::Mesh() : body_(std::make_shared<const Body>()) {}

Mesh::Mesh(TriangleSurface surface, double one_contact_angle) {
    if (!(one_contact_angle >= 0 && one_contact_angle < std::numbers::pi / 4))
        throw std::invalid_argument("the angle below which contacts with a mesh are one must lie in [0, pi/4)");
    if (surface.triangles.empty()) throw std::invalid_argument("a mesh needs a triangle");
    for (const Vec3& corner : surface.corners)
        for (const double c : corner)
            if (!(std::abs(c) <= largest_coordinate))
                throw std::invalid_argument("every corner of a mesh must lie within 1e9 m of the origin");
    auto body = std::make_shared<Body>();
    body->triangles.reserve(surface.triangles.size());
    for (const auto& ids : surface.triangles) {
        std::array<Vec3, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (ids[k] < 0 || static_cast<std::size_t>(ids[k]) >= surface.corners.size())
                throw std::invalid_argument("every triangle of a mesh must be of corners that it has");
            corners[k] = surface.corners[static_cast<std::size_t>(ids[k])];
        }
        body->triangles.push_back(Triangle::of(corners));
        if (!finite(body->triangles.back().normal))
            throw std::invalid_argument("every triangle of a mesh must have an area");
    }
    body->grid = TriangleGrid(body->triangles);
    body->tolerance = weld_tolerance * norm(body->grid.high() - body->grid.low());
    body->surface = std::move(surface);
    body->one_contact_angle = one_contact_angle;
    body_ = std::move(body);
}

Mesh Mesh::repeated(const Domain& domain, double margin) const {
    auto body = std::make_shared<Body>(*body_);
    for (std::size_t k = 0; k < 3; ++k) {
        if (!domain.periodic[k]) continue;
        const double period = domain.length(k);
        std::vector<Triangle> images;
        for (const Triangle& t : body->triangles) {
            const auto [least, most] = std::minmax({t.corner[0][k], t.corner[1][k], t.corner[2][k]});
            const auto first = std::ceil((domain.low[k] - margin - most) / period);
            const auto last = std::floor((domain.high[k] + margin - least) / period);
            for (double n = first; n <= last; ++n) {
                Triangle image = t;
                for (Vec3& corner : image.corner) corner[k] += n * period;
                images.push_back(image);
            }
        }
        body->triangles = std::move(images);
    }
    body->grid = TriangleGrid(body->triangles);
    Mesh all;
    all.body_ = std::move(body);
    return all;
}

void Mesh::near(const Vec3& position, double reach, std::vector<std::uint32_t>& into) const {
    const Vec3 margin = {reach, reach, reach};
    body_->grid.in_box(position - margin, position + margin, into);
    const double beyond = (1 + 1e-9) * reach + tolerance();
    std::erase_if(into, [&](std::uint32_t t) {
        if (!body_->prisms.empty()) {  // most are farther than their planes alone say
            const auto h = body_->prisms[t].heights(position);
            const double outside = std::max({h[0], h[1], h[2], 0.0});
            if (!(h[3] * h[3] + outside * outside <= beyond * beyond)) return true;
        }
        return !(body_->triangles[t].nearest(position).distance < reach);
    });
}

void Mesh::contacts(const Vec3& position, double reach, std::vector<MeshContact>& into) const {
    std::vector<std::uint32_t> triangles;
    near(position, reach, triangles);
    contacts(position, reach, triangles, into);
}

void Mesh::contacts(const Vec3& position, double reach, std::span<const std::uint32_t> triangles,
                    std::vector<MeshContact>& into) const {
    into.clear();
    for (const std::uint32_t t : triangles) {
        const MeshContact touched = contact_with(body_->triangles[t], t, position);
        if (touched.distance < reach) into.push_back(touched);
    }
    if (into.size() < 2) return;
    if (const auto face = only_face(body_->triangles, tolerance(), into)) {
        into.front() = into[*face];
        into.resize(1);
        return;
    }
    std::ranges::sort(into, {},
                      [](const MeshContact& c) { return std::tuple(c.feature, c.distance, c.point, c.normal); });
    keep_places(into);
    if (into.size() < 2) return;
    std::ranges::sort(into, {},
                      [](const MeshContact& c) { return std::tuple(c.distance, c.feature, c.point, c.normal); });
    if (one_contact_angle() > 0) unite_normals(into);
}

Mesh::Prism::Prism(const Triangle& t) {
    const auto set = [&](std::size_t k, const Vec3& normal, const Vec3& point) {
        x[k] = normal[0], y[k] = normal[1], z[k] = normal[2], offset[k] = dot(normal, point);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = t.corner[k];
        const Vec3 across = cross(t.corner[(k + 1) % 3] - a, t.normal);
        // That the third corner lies inside of.
        const double side = dot(across, t.corner[(k + 2) % 3] - a) > 0 ? -1 : 1;
        set(k, (side / norm(across)) * across, a);
    }
    set(3, t.normal, t.corner[0]);
}

Mesh Mesh::prepared(double reach) const {
    auto body = std::make_shared<Body>(*body_);
    body->reach = reach;
    body->reached = TriangleGrid(body->triangles, reach);
    body->prisms.clear();
    for (const Triangle& t : body->triangles) body->prisms.emplace_back(t);
    Mesh same;
    same.body_ = std::move(body);
    return same;
}

void Mesh::touching(const Vec3& x, double reach, std::span<const std::uint32_t> of, std::vector<Closest>& into) const {
    if (const auto face = face_beside_sides(body_->triangles, body_->prisms, tolerance(), x, reach, of)) {
        const MeshContact one = contact_with(body_->triangles[*face], *face, x);
        if (one.distance < reach) into.push_back({one.distance, one.normal});
        return;
    }
    std::vector<MeshContact> found;
    contacts(x, reach, of, found);
    for (const MeshContact& c : found) into.push_back({c.distance, c.normal});
}

void Mesh::touching(const Vec3& x, double reach, std::vector<Closest>& into) const {
    const auto add = [&](const MeshContact& c) { into.push_back({c.distance, c.normal}); };
    if (reach > body_->reach) {
        std::vector<MeshContact> found;
        contacts(x, reach, found);
        std::ranges::for_each(found, add);
        return;
    }
    // Rounding errors of the planes are far below the tolerance: excluded triangles are farther than the reach, and a
    // foot found inside the sides is inside.
    const double beyond = (1 + 1e-9) * reach + tolerance();
    std::array<std::uint32_t, 16> few{};
    std::size_t count = 0;
    double last_outside = 0;
    const auto here = body_->reached.at(x);
    for (const std::uint32_t t : here) {
        const auto h = body_->prisms[t].heights(x);
        const double beside = std::max(std::max(h[0], h[1]), h[2]), outside = std::max(beside, 0.0);
        if (!(h[3] * h[3] + outside * outside <= beyond * beyond)) continue;
        if (count < few.size()) few[count] = t;
        last_outside = beside;
        ++count;
    }
    if (count == 0) return;
    if (count == 1) {
        const Triangle& t = body_->triangles[few[0]];
        if (last_outside < -tolerance()) {  // its face
            const double height = t.height(x);
            if (std::abs(height) < reach) into.push_back({std::abs(height), height >= 0 ? t.normal : -t.normal});
            return;
        }
        const MeshContact one = contact_with(t, few[0], x);
        if (one.distance < reach) add(one);
        return;
    }
    std::vector<MeshContact> found;
    contacts(x, reach, count <= few.size() ? std::span<const std::uint32_t>(few).first(count) : here, found);
    std::ranges::for_each(found, add);
}

/// Steps 2 and 3, to the sorted nearest points: faces before edges before vertices.
void Mesh::keep_places(std::vector<MeshContact>& touched) const {
    // Points in one place: those within two tolerances of one another, and of those again.
    std::vector<std::size_t> place(touched.size());
    for (std::size_t k = 0; k < touched.size(); ++k) {
        place[k] = k;
        for (std::size_t n = 0; n < k; ++n) {
            const std::size_t from = std::max(place[n], place[k]), to = std::min(place[n], place[k]);
            if (from == to || !within(touched[n].point, touched[k].point, 2 * tolerance())) continue;
            for (std::size_t m = 0; m <= k; ++m)
                if (place[m] == from) place[m] = to;
        }
    }
    // A place without a face is none where one of its points lies on a triangle that is nearest elsewhere.
    std::vector<bool> passed_over(touched.size(), false);
    for (std::size_t k = 0; k < touched.size(); ++k) {
        const std::size_t mine = place[k];
        if (touched[mine].feature == Feature::face || passed_over[mine]) continue;
        for (std::size_t n = 0; n < touched.size() && !passed_over[mine]; ++n)
            passed_over[mine] = place[n] != mine &&
                                body_->triangles[touched[n].triangle].nearest(touched[k].point).distance <= tolerance();
    }
    const MeshContact nearest = *std::ranges::min_element(touched, {}, &MeshContact::distance);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < touched.size(); ++k)
        if (place[k] == k && !passed_over[k]) touched[kept++] = touched[k];
    // The nearest of all is passed over by rounding only, between triangles that meet within the tolerance.
    if (kept == 0) touched[kept++] = nearest;
    touched.resize(kept);
}

/// Step 4, to places sorted by distance.
void Mesh::unite_normals(std::vector<MeshContact>& places) const {
    const double chord = 2 * std::sin(one_contact_angle() / 2);
    std::size_t kept = 0;
    for (const MeshContact& place : std::vector<MeshContact>(places)) {
        const auto is_one = [&](const MeshContact& other) { return within(other.normal, place.normal, chord); };
        if (std::none_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(kept), is_one))
            places[kept++] = place;
    }
    places.resize(kept);
}

std::optional<std::uint32_t> Mesh::crossed(const Vec3& from, const Vec3& to) const {
    Vec3 low = from, high = to;
    for (std::size_t k = 0; k < 3; ++k)
        if (low[k] > high[k]) std::swap(low[k], high[k]);
    std::vector<std::uint32_t> beside;
    body_->grid.in_box(low, high, beside);
    for (const std::uint32_t n : beside) {
        const Triangle& t = body_->triangles[n];
        const double before = t.height(from);
        const double after = t.height(to);
        if ((before > 0) == (after > 0)) continue;
        const Vec3 through = from + (before / (before - after)) * (to - from);
        if (t.nearest(through).distance <= tolerance()) return n;
    }
    return std::nullopt;
}

}  // namespace grainsweep::geometry
