#include "tests/support/plain_dem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests {

using dem::Vec3;
using std::numbers::pi;

namespace {

Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3 operator*(double s, const Vec3& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

struct PlainDem::Contact {
    Vec3 n, velocity, surface;  // v_i - v_j; (R_i - d/2) w_i + (R_j - d/2) w_j
    double overlap, radius, mass;
    double root;             // radius of the contact
    double neck;             // attraction
    double forgiven;         // what Coulomb's limit has beyond the net force
    Vec3 turning;            // w_i - w_j
    double inverse_inertia;  // sum of 1/(7/5 m R^2)
    bool at_wall = false;
    dem::Material material;  // of both, or of the wall's surface
};

PlainDem::PlainDem(const dem::Setup& setup) : setup_(setup), gone_(setup.spheres.size(), 0) {
    for (const dem::Sphere& s : setup.spheres) {
        x_.push_back(s.position);
        v_.push_back(s.mobile ? s.velocity + (1 / setup.time_step) * displacement(1) : Vec3{});
        w_.push_back(s.mobile ? s.angular_velocity : Vec3{});
    }
    move_frozen();
    forces(false);
}

Vec3 PlainDem::displacement(std::int64_t step) const {
    const double t = static_cast<double>(step) * setup_.time_step;
    return std::sin(2 * pi * setup_.shaking.frequency * t) * setup_.shaking.amplitude;
}

/// Places of frozen spheres at the present step, and their velocities over the last one.
void PlainDem::move_frozen() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
        if (setup_.spheres[i].mobile) continue;
        x_[i] = setup_.spheres[i].position + displacement(steps_);
        v_[i] = (1 / setup_.time_step) * (displacement(steps_) - displacement(steps_ - 1));
    }
}

double PlainDem::mass(std::size_t i) const {
    const double r = setup_.spheres[i].radius;
    return setup_.spheres[i].mobile ? 4.0 / 3 * pi * r * r * r * setup_.material.density : INFINITY;
}

double PlainDem::kinetic_energy() const {
    double e = 0;
    for (std::size_t i = 0; i < x_.size(); ++i)
        if (setup_.spheres[i].mobile && gone_[i] == 0) e += 0.5 * mass(i) * dot(v_[i], v_[i]);
    return e;
}

/// The normal force that friction sees: the damper in approach without what it pulls at the end of an impact.
double PlainDem::of_limit(const dem::Material& m, double force, double damper, double speed) {
    if (m.tangential_limit == dem::TangentialLimit::spring) return std::abs(force);
    const double z = -std::log(m.restitution) / std::hypot(std::log(m.restitution), pi), w = std::sqrt(1 - z * z);
    const double at_depth = std::exp(-z * std::acos(z) / w);  // of an oscillator with a period of 2 pi/w
    const double pulled = at_depth * at_depth - m.restitution, pushed = 2 * z * at_depth;
    if (speed < 0 && z > 0) force += pulled / pushed * damper * speed;
    return std::max(force, 0.0);
}

void PlainDem::respond(const Contact& c, bool update, Vec3& history, Vec3& force, Vec3& turn) const {
    const dem::Material& m = c.material;
    const double young = m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
    const double shear = m.youngs_modulus / (4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio));
    const double log_e = std::log(m.restitution), beta = log_e / std::sqrt(log_e * log_e + pi * pi);
    const double root = c.root;
    const double kn = 4.0 / 3 * young * root, kt = 8 * shear * root;
    const double gn = -2 * std::sqrt(5.0 / 6) * beta * std::sqrt(2 * young * root * c.mass);
    const double gt = -2 * std::sqrt(5.0 / 6) * beta * std::sqrt(8 * shear * root * c.mass);
    const double vn = dot(c.velocity, c.n);
    const double normal = kn * c.overlap - gn * vn;
    const Vec3 vt = c.velocity - vn * c.n - cross(c.surface, c.n);
    Vec3 s = history;
    if (update) s = s + setup_.time_step * vt;
    s = s - dot(s, c.n) * c.n;
    const double limit = m.friction * of_limit(m, normal - c.neck + c.forgiven, gn, vn);
    const bool cut = kt * norm(s) > limit;
    if (cut) s = (limit / (kt * norm(s))) * s;
    double damper = cut ? 0 : gt;
    if (m.tangential_limit == dem::TangentialLimit::sum && damper * norm(vt) > limit - kt * norm(s))
        damper = std::max(limit - kt * norm(s), 0.0) / norm(vt);
    Vec3 tangential = (-kt) * s - damper * vt;
    if (m.friction == 0) tangential = s = {};
    if (update) history = s;
    force = (normal - c.neck) * c.n + tangential;
    turn = cross(c.n, tangential);
}

Vec3 PlainDem::rolling(const Contact& c, bool update, Vec3& history, const Vec3& force) const {
    const dem::Material& m = c.material;
    if (m.rolling_friction == 0) return {};
    const double young = m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
    const double kn = 4.0 / 3 * young * c.root;
    if (m.rolling_law == dem::RollingLaw::cdt) {
        const double turns = norm(c.turning);
        if (turns == 0) return {};
        double elastic = kn * c.overlap;
        if (m.cohesion_law == dem::CohesionLaw::jkr && m.surface_energy > 0)
            elastic += 3 * pi * m.surface_energy * c.radius - c.neck;
        const Vec3 torque = (m.rolling_friction * elastic * c.radius / turns) * c.turning;
        return (-1.0) * (torque - dot(torque, c.n) * c.n);
    }
    const double kr = 2.25 * kn * std::pow(m.rolling_friction * c.radius, 2);
    const double log_e = std::log(m.restitution), beta = log_e / std::sqrt(log_e * log_e + pi * pi);
    const double gn = -2 * std::sqrt(5.0 / 6) * beta * std::sqrt(2 * young * c.root * c.mass);
    const double limit =
        m.rolling_friction * c.radius * of_limit(m, dot(force, c.n) + c.forgiven, gn, dot(c.velocity, c.n));
    const Vec3 turning = c.turning - dot(c.turning, c.n) * c.n;
    Vec3 moment = history;
    if (update) moment = moment + (setup_.time_step * kr) * turning;
    double damper = 2 * m.rolling_damping * std::sqrt(kr / c.inverse_inertia);
    if (norm(moment) > limit) {
        moment = (limit / norm(moment)) * moment;
        damper = 0;
    }
    if (m.tangential_limit == dem::TangentialLimit::sum && damper * norm(turning) > limit - norm(moment))
        damper = std::max(limit - norm(moment), 0.0) / norm(turning);
    if (update) history = moment;
    return (-1.0) * (moment + damper * turning);
}

/// Radius and attraction of a contact; `area` of those that attract by one.
void PlainDem::attract(Contact& c, double area) {
    const dem::Material& m = c.material;
    const double young = m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio)), w = m.surface_energy;
    c.root = std::sqrt(c.radius * std::max(c.overlap, 0.0));
    c.neck = m.cohesion * area;
    c.forgiven = c.neck;
    if (m.cohesion_law == dem::CohesionLaw::dmt) c.neck = c.forgiven = 2 * pi * w * c.radius;
    if (m.cohesion_law == dem::CohesionLaw::jkr && w > 0) {
        double low = std::cbrt(pi * w * c.radius * c.radius / (8 * young)), high = 10 * c.radius;
        for (int k = 0; k < 100; ++k) {  // d(a) grows beyond `low`
            const double a = (low + high) / 2;
            (a * a / c.radius - std::sqrt(2 * pi * w * a / young) < c.overlap ? low : high) = a;
        }
        c.root = low;
        c.neck = 2.0 / 3 * std::sqrt(2 * pi * w * young * low * low * low);
        c.forgiven = 3 * pi * w * c.radius;
    }
    if (m.cohesion_law == dem::CohesionLaw::capillary) {
        const double x = std::max(-c.overlap, 0.0) * std::sqrt(2 * c.radius / bridge_volume(m, c.radius, c.at_wall));
        c.neck = c.forgiven =
            4 * pi * c.radius * m.surface_tension * std::cos(m.contact_angle) / (1 + 1.05 * x + 2.5 * x * x);
    }
    if (m.friction_limit == dem::FrictionLimit::net) c.forgiven = 0;
}

/// Of a liquid bridge between bodies with this R*.
double PlainDem::bridge_volume(const dem::Material& m, double radius, bool at_wall) {
    const double of_sphere = at_wall ? radius : 2 * radius;
    return m.bridge_volume * 4.0 / 3 * pi * of_sphere * of_sphere * of_sphere;
}

/// The overlap at which a contact ends, which lasts beyond touch if it is old and its law is JKR's or has bridges.
double PlainDem::end_of_contact(const dem::Material& m, double radius, bool lasts, bool at_wall) {
    if (lasts && m.cohesion_law == dem::CohesionLaw::capillary)
        return -(1 + m.contact_angle / 2) * std::cbrt(bridge_volume(m, radius, at_wall));
    if (!lasts || m.cohesion_law != dem::CohesionLaw::jkr) return 0;
    const double ratio = 2 * pi * m.surface_energy * (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
    return -0.75 * std::cbrt(ratio * ratio * radius);
}

void PlainDem::pair(std::size_t i, std::size_t j, bool update) {
    Vec3 d = x_[i] - x_[j];
    for (std::size_t a = 0; a < 3; ++a)
        if (setup_.domain.periodic[a]) {
            const double period = setup_.domain.high[a] - setup_.domain.low[a];
            d[a] -= period * std::nearbyint(d[a] / period);
        }
    const double ri = setup_.spheres[i].radius, rj = setup_.spheres[j].radius;
    if (dot(d, d) > 1.8 * (ri + rj) * (ri + rj)) return;  // far: it left contact, and was forgotten, on its way
    const bool of_powder = setup_.spheres[i].mobile && setup_.spheres[j].mobile;
    const dem::Material m = of_powder ? setup_.material : dem::at_surface(setup_.material, setup_.frozen);
    const double r = norm(d), overlap = ri + rj - r;
    if (overlap <= end_of_contact(m, ri * rj / (ri + rj), pairs_that_last_.contains({i, j}), false)) {
        pair_history_.erase({i, j});
        pair_rolling_.erase({i, j});
        pairs_that_last_.erase({i, j});
        return;
    }
    if (update) pairs_that_last_.insert({i, j});
    largest_overlap_ = std::max(largest_overlap_, overlap / (2 * std::min(ri, rj)));
    Contact c{};
    c.material = m;
    c.n = (1 / r) * d;
    c.overlap = overlap;
    c.velocity = v_[i] - v_[j];
    c.surface = (ri - overlap / 2) * w_[i] + (rj - overlap / 2) * w_[j];
    c.radius = ri * rj / (ri + rj);
    c.mass = 1 / (1 / mass(i) + 1 / mass(j));
    double area = 0;
    if (m.cohesion_law == dem::CohesionLaw::sjkr)
        area = -pi / 4 * (r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj) / (r * r);
    else if (m.cohesion_law == dem::CohesionLaw::sjkr2)
        area = 2 * pi * 2 * c.radius * overlap;
    else
        area = pi * (2 * c.radius * overlap - overlap * overlap) / 4;
    attract(c, area);
    if (m.cohesion_law == dem::CohesionLaw::capillary && overlap <= 0) {
        f_[i] = f_[i] - c.neck * c.n;
        f_[j] = f_[j] + c.neck * c.n;
        pair_history_.erase({i, j});
        pair_rolling_.erase({i, j});
        return;
    }
    Vec3 force{}, turn{};
    respond(c, update, pair_history_[{i, j}], force, turn);
    f_[i] = f_[i] + force;
    f_[j] = f_[j] - force;
    c.turning = w_[i] - w_[j];
    c.inverse_inertia = (1 / (mass(i) * ri * ri) + 1 / (mass(j) * rj * rj)) / 1.4;
    const Vec3 moment = rolling(c, update, pair_rolling_[{i, j}], force);
    t_[i] = t_[i] - (ri - overlap / 2) * turn + moment;
    t_[j] = t_[j] - (rj - overlap / 2) * turn - moment;
}

void PlainDem::wall(std::size_t i, std::size_t w, bool update) {
    const dem::Material m = dem::at_surface(setup_.material, setup_.walls[w].surface);
    const double ri = setup_.spheres[i].radius, t = static_cast<double>(wall_steps_) * setup_.time_step;
    Contact c{};
    c.material = m;
    double distance = 0;
    const dem::Wall& wall = setup_.walls[w];
    const auto pose = geometry::pose_at(wall.motions, t);
    const Vec3 in_body = pose.to_body(x_[i]);
    if (const auto* plane = std::get_if<dem::Plane>(&wall.shape)) {
        c.n = (1 / norm(plane->normal)) * plane->normal;
        distance = dot(in_body - plane->point, c.n);
    } else if (const auto* b = std::get_if<dem::Bar>(&wall.shape)) {
        const double shrink = in_body[2] < b->bottom + b->edge_radius ? b->edge_radius : 0;
        const Vec3 closest{std::clamp(in_body[0], b->front - b->thickness + shrink, b->front - shrink), in_body[1],
                           std::clamp(in_body[2], b->bottom + shrink, b->top)};
        const Vec3 d = in_body - closest;
        distance = norm(d) - shrink;
        c.n = (1 / norm(d)) * d;
    } else {  // which have tests of their own
        const auto closest = std::visit(
            [&]<class S>(const S& shape) -> geometry::Closest {
                if constexpr (geometry::SingleContact<S>) return shape.closest(in_body);
                throw std::logic_error("PlainDem has walls with one contact only");
            },
            wall.shape);
        distance = closest.distance;
        c.n = closest.normal;
    }
    c.n = pose.turn(c.n);
    c.velocity = v_[i] - geometry::twist_at(wall.motions, t).at(x_[i] - distance * c.n, c.n);
    c.overlap = ri - distance;
    if (c.overlap <= end_of_contact(m, ri, at_walls_that_last_.contains({i, w}), true)) {
        wall_history_.erase({i, w});
        wall_rolling_.erase({i, w});
        at_walls_that_last_.erase({i, w});
        return;
    }
    if (update) at_walls_that_last_.insert({i, w});
    c.surface = (ri - c.overlap / 2) * w_[i];
    c.radius = ri;
    c.at_wall = true;
    c.mass = mass(i);
    const double area = m.cohesion_law == dem::CohesionLaw::sjkr ? pi * (2 * ri * c.overlap - c.overlap * c.overlap)
                        : m.cohesion_law == dem::CohesionLaw::sjkr2
                            ? 2 * pi * ri * c.overlap
                            : pi * (2 * ri * c.overlap - c.overlap * c.overlap) / 4;
    attract(c, area);
    if (m.cohesion_law == dem::CohesionLaw::capillary && c.overlap <= 0) {
        f_[i] = f_[i] - c.neck * c.n;
        wall_history_.erase({i, w});
        wall_rolling_.erase({i, w});
        return;
    }
    Vec3 force{}, turn{};
    respond(c, update, wall_history_[{i, w}], force, turn);
    f_[i] = f_[i] + force;
    c.turning = w_[i];
    c.inverse_inertia = 1 / (1.4 * mass(i) * ri * ri);
    t_[i] = t_[i] - (ri - c.overlap / 2) * turn + rolling(c, update, wall_rolling_[{i, w}], force);
}

void PlainDem::forces(bool update) {
    const std::size_t n = x_.size();
    f_.assign(n, Vec3{});
    t_.assign(n, Vec3{});
    largest_overlap_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (gone_[i] != 0) continue;
        const bool mobile = setup_.spheres[i].mobile;
        if (mobile) f_[i] = f_[i] + mass(i) * setup_.gravity;
        for (std::size_t w = 0; w < setup_.walls.size() && mobile; ++w) wall(i, w, update);
        for (std::size_t j = i + 1; j < n; ++j)
            if (gone_[j] == 0 && (mobile || setup_.spheres[j].mobile)) pair(i, j, update);
    }
}

void PlainDem::run(std::int64_t steps) {
    const double half = 0.5 * setup_.time_step;
    const auto kick = [&](std::size_t i) {
        const double m = mass(i), r = setup_.spheres[i].radius;
        v_[i] = v_[i] + (half / m) * f_[i];
        w_[i] = w_[i] + (half / (0.4 * m * r * r)) * t_[i];
    };
    for (std::int64_t s = 0; s < steps; ++s) {
        for (std::size_t i = 0; i < x_.size(); ++i)
            if (setup_.spheres[i].mobile && gone_[i] == 0) {
                kick(i);
                x_[i] = x_[i] + setup_.time_step * v_[i];
            }
        ++wall_steps_;
        ++steps_;
        move_frozen();
        forces(true);
        for (std::size_t i = 0; i < x_.size(); ++i)
            if (setup_.spheres[i].mobile && gone_[i] == 0) kick(i);
    }
}

void PlainDem::set_walls(std::vector<dem::Wall> walls) {
    setup_.walls = std::move(walls);
    wall_history_.clear();
    wall_rolling_.clear();
    wall_steps_ = 0;
    forces(false);
}

void PlainDem::remove(std::int32_t id) {
    gone_[static_cast<std::size_t>(id)] = 1;
    for (auto* histories : {&pair_history_, &pair_rolling_})
        std::erase_if(*histories, [&](const auto& h) {
            return h.first.first == static_cast<std::size_t>(id) || h.first.second == static_cast<std::size_t>(id);
        });
    forces(false);
}

}  // namespace grainsweep::tests
