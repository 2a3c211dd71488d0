#include "solver/machine/grain_shapes.hpp"

#include "solver/geometry/stl.hpp"

#include <cmath>
#include <list>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace grainsweep::machine {
namespace {

using geometry::Ball;
using geometry::operator*;
using geometry::operator-;

void require_shape(const std::vector<Ball>& balls) {
    if (const std::string flaw = particles::flaw_of(balls); !flaw.empty()) throw std::invalid_argument(flaw);
}

GrainShape made_of(std::vector<Ball> balls, const geometry::Solid& solid) {
    auto clump = particles::clump_of(balls, solid);
    return {std::move(clump), std::move(balls), solid, {}};
}

GrainShape covered(std::string_view contents, const particles::CoverRequest& request) {
    const auto surface = geometry::read_stl(contents).surface;
    auto cover = particles::ball_cover(surface, request);
    if (cover.balls.size() < 2)
        throw std::invalid_argument("one sphere covers the body: leave \"shape\" out, or ask for more \"spheres\"");
    if (!particles::flaw_of(cover.balls).empty())
        throw std::invalid_argument(
            "the spheres that cover it do not hang together: ask for more \"spheres\", or list them");
    GrainShape shape = made_of(std::move(cover.balls), *geometry::solid_of(surface));
    shape.overlap = cover.overlap;
    return shape;
}

}  // namespace

GrainShape row_shape(double aspect_ratio) {
    return ball_shape(particles::row_of(aspect_ratio));
}

GrainShape ball_shape(std::vector<Ball> balls) {
    require_shape(balls);
    const auto solid = geometry::solid_of(balls);
    return made_of(std::move(balls), solid);
}

GrainShape mesh_shape(std::string_view contents, const particles::CoverRequest& request) {
    struct Known {
        std::string contents;
        std::size_t most;
        std::optional<double> error;
        GrainShape shape;
    };
    constexpr std::size_t kept = 8;
    static std::mutex mutex;
    static std::list<Known> known;
    const std::lock_guard lock(mutex);
    for (const Known& one : known)
        if (one.contents == contents && one.most == request.most && one.error == request.error) return one.shape;
    GrainShape shape = covered(contents, request);
    known.push_front({std::string(contents), request.most, request.error, shape});
    if (known.size() > kept) known.pop_back();
    return shape;
}

void take_mass(GrainShape& shape, const OwnMass& own, double diameter, double density) {
    if (!own.mass && !own.inertia && !own.centre) return;
    // As the particles are: of this diameter.
    const double scale = diameter / shape.clump.diameter;
    std::vector<Ball> balls;
    for (const Ball& ball : shape.balls) balls.push_back({scale * ball.centre, scale * ball.radius});
    geometry::Solid solid = shape.solid;
    const double cube = scale * scale * scale, fifth = cube * scale * scale;
    solid.volume *= cube;
    solid.centre = scale * solid.centre;
    solid.inertia = fifth * solid.inertia;
    const geometry::Vec3 centre = own.centre ? scale * *own.centre : solid.centre;
    const double mass = own.mass.value_or(density * solid.volume);
    geometry::Inertia inertia{};
    if (own.inertia) {
        inertia = *own.inertia;
    } else {
        for (std::size_t k = 0; k < 3; ++k)
            geometry::add_square(inertia, solid.axes[k], solid.inertia[k] * mass / solid.volume);
    }
    if (const auto flaw = particles::flaw_of(balls, solid, density, mass, inertia, centre); !flaw.empty())
        throw std::invalid_argument(flaw);
    for (double& c : inertia) c /= density;
    const geometry::Solid body = geometry::solid_of(solid.volume, centre, inertia);
    shape.clump = particles::clump_of(balls, body);
    const double d = shape.clump.diameter;
    particles::take_mass(shape.clump, mass / (density * d * d * d), shape.clump.inertia);
    shape.clump.centre = (1 / scale) * shape.clump.centre;
    shape.clump.diameter = d / scale;
}

}  // namespace grainsweep::machine
