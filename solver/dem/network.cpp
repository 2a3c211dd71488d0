#include "solver/dem/network.hpp"

#include "stats/random.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace grainsweep::dem {

using namespace geometry;

namespace {

constexpr int most_iterations = 20;
constexpr int least_iterations = 6;
constexpr double converged = 5e-3;  ///< relative growth of the eigenvalue per iteration

/// Springs and dampers of a contact, weighted.
struct Weighted {
    double normal, tangential, rolling;

    Weighted(const Springs& s, double of_springs, double of_dampers)
        : normal(of_springs * s.normal + of_dampers * s.normal_damper),
          tangential(of_springs * s.tangential + of_dampers * s.tangential_damper),
          rolling(of_springs * s.rolling + of_dampers * s.rolling_damper) {}
};

/// Returns the largest eigenvalue of a contact between fixed masses of 1 with the inertia of spheres.
double strength(const Bond& bond, const Weighted& w) {
    const auto& [normal, tangential, rolling] = w;
    const double lever = std::max(bond.lever_first, bond.lever_second);
    return std::max(normal, 3.5 * tangential + 2.5 * rolling / (lever * lever));
}

Vec3 at(const double* x) {
    return {x[0], x[1], x[2]};
}

void add_to(double* x, const Vec3& a) {
    for (std::size_t k = 0; k < 3; ++k) x[k] += a[k];
}

}  // namespace

std::vector<Freedom> freedoms_of(const MovingWall& wall, double time) {
    std::vector<Freedom> all;
    const auto acts = [time](const auto& m) { return time >= m.start && time < m.end; };
    for (const Motion& motion : wall.wall().motions) {
        if (const auto* press = std::get_if<Press>(&motion); press != nullptr && acts(*press))
            all.push_back({.inertia = press->mass, .velocity = press->along});
        if (const auto* drive = std::get_if<Drive>(&motion); drive != nullptr && acts(*drive))
            all.push_back({.inertia = drive->inertia, .spin = drive->axis, .pivot = wall.twist().pivot});
        if (const auto* flight = std::get_if<Flight>(&motion); flight != nullptr && acts(*flight))
            for (std::size_t k = 0; k < 3; ++k) {
                Vec3 along{};
                along[k] = 1;
                if (flight->freedom[k] != 0) all.push_back({.inertia = flight->mass, .velocity = along});
                all.push_back({.inertia = flight->inertia[k],
                               .spin = wall.pose().turned ? wall.pose().turn(flight->axes[k]) : flight->axes[k],
                               .pivot = wall.twist().pivot});
            }
    }
    return all;
}

void Network::clear(std::vector<std::uint64_t> lasting) {
    lasting_ = std::move(lasting);
    inverse_mass_.clear(), inverse_inertia_.clear(), freedoms_.clear(), bonds_.clear(), columns_.clear();
    bodies_.clear(), carriers_.clear();
    wall_begin_ = 0;
}

void Network::add_wall(const std::vector<Freedom>& freedoms) {
    wall_begin_ = freedoms_.size();
    freedoms_.insert(freedoms_.end(), freedoms.begin(), freedoms.end());
}

void Network::add_at_wall(Bond bond, const Vec3& point) {
    bond.columns = static_cast<std::int32_t>(columns_.size());
    for (std::size_t k = wall_begin_; k < freedoms_.size(); ++k) {
        const Freedom& f = freedoms_[k];
        columns_.push_back({static_cast<std::int32_t>(k), f.velocity + cross(f.spin, point - f.pivot)});
    }
    bond.columns_end = static_cast<std::int32_t>(columns_.size());
    bonds_.push_back(bond);
}

std::vector<std::uint64_t> Network::keys() const {
    std::vector<std::uint64_t> all;
    all.reserve(bonds_.size());
    for (const Bond& bond : bonds_) all.push_back(bond.key);
    std::ranges::sort(all);
    return all;
}

template <bool clumped>
Network::Moved Network::motion_of(std::int32_t sphere, const double* speeds) const {
    const Carrier* const by = clumped ? carrier(sphere) : nullptr;
    const double* const x = speeds + 6 * (clumped ? node_of(sphere) : static_cast<std::size_t>(sphere));
    if (by == nullptr) return {at(x), at(x + 3)};
    const Vec3 turning = in_space(bodies_[static_cast<std::size_t>(by->body)].axes, at(x + 3));
    return {at(x) + cross(turning, by->lever), turning};
}

template <bool clumped>
void Network::push(std::int32_t sphere, const Vec3& force, const Vec3& moment, double* forces) const {
    const Carrier* const by = clumped ? carrier(sphere) : nullptr;
    double* const x = forces + 6 * (clumped ? node_of(sphere) : static_cast<std::size_t>(sphere));
    add_to(x, force);
    if (by == nullptr) return add_to(x + 3, moment);
    const Axes& axes = bodies_[static_cast<std::size_t>(by->body)].axes;
    const Vec3 about_centre = moment + cross(by->lever, force);
    add_to(x + 3, {dot(axes[0], about_centre), dot(axes[1], about_centre), dot(axes[2], about_centre)});
}

double Network::load_of(const Bond& bond, std::int32_t sphere, double strength, double normal, double tangential,
                        double rolling) const {
    const Carrier* const by = carrier(sphere);
    if (by == nullptr) return strength;
    // Trace of the contact's matrix, which bounds its eigenvalue, times the mass by which bound() divides.
    const BodyNode& body = bodies_[static_cast<std::size_t>(by->body)];
    const bool first = sphere == bond.first;
    const Vec3 arm = by->lever + (first ? -bond.lever_first : bond.lever_second) * bond.normal;
    const Vec3 across = std::abs(bond.normal[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 sideways = cross(bond.normal, across), u = (1 / norm(sideways)) * sideways, v = cross(bond.normal, u);
    const auto mobility = [&](const Vec3& direction) {
        return body.inverse_mass + added_inverse_mass(cross(arm, direction), body.axes, body.inverse_inertia);
    };
    const double least = *std::ranges::min_element(body.inertia);
    const double trace =
        normal * mobility(bond.normal) + tangential * (mobility(u) + mobility(v)) + 2 * rolling / least;
    return trace / body.inverse_mass;
}

double Network::bound(double time_step) const {
    const double of_springs = time_step * time_step, of_dampers = 2 * time_step;
    load_.assign(nodes() + freedoms_.size(), 0.0);
    const std::size_t spheres = inverse_mass_.size(), all = nodes();
    for (const Bond& bond : bonds_) {
        const Weighted w(bond.springs, of_springs, of_dampers);
        const double s = strength(bond, w);
        const auto load = [&](std::int32_t sphere) {
            load_[node_of(sphere)] += load_of(bond, sphere, s, w.normal, w.tangential, w.rolling);
        };
        load(bond.first);
        if (bond.second >= 0) load(bond.second);
        for (std::int32_t c = bond.columns; c < bond.columns_end; ++c) {
            const Column& column = columns_[static_cast<std::size_t>(c)];
            load_[all + static_cast<std::size_t>(column.freedom)] += s * dot(column.velocity, column.velocity);
        }
    }
    for (std::size_t i = 0; i < spheres; ++i) load_[i] *= inverse_mass_[i];
    for (std::size_t b = 0; b < bodies_.size(); ++b) load_[spheres + b] *= bodies_[b].inverse_mass;
    for (std::size_t k = 0; k < freedoms_.size(); ++k) load_[all + k] /= freedoms_[k].inertia;
    double largest = 0;
    for (const Bond& bond : bonds_) {
        double sum = load_[node_of(bond.first)];
        if (bond.second >= 0) sum += load_[node_of(bond.second)];
        for (std::int32_t c = bond.columns; c < bond.columns_end; ++c)
            sum += load_[all + static_cast<std::size_t>(columns_[static_cast<std::size_t>(c)].freedom)];
        largest = std::max(largest, sum);
    }
    return largest;
}

template <bool clumped>
void Network::apply(double of_springs, double of_dampers, const double* speeds, double* force) const {
    const std::size_t walls = 6 * nodes();
    for (const Bond& bond : bonds_) {
        const auto [normal, tangential, rolling] = Weighted(bond.springs, of_springs, of_dampers);
        auto [velocity, turning] = motion_of<clumped>(bond.first, speeds);
        Vec3 surface = bond.lever_first * turning;
        if (bond.second >= 0) {
            const Moved other = motion_of<clumped>(bond.second, speeds);
            velocity = velocity - other.velocity;
            turning = turning - other.turning;
            surface += bond.lever_second * other.turning;
        }
        for (std::int32_t c = bond.columns; c < bond.columns_end; ++c) {
            const Column& column = columns_[static_cast<std::size_t>(c)];
            velocity = velocity - speeds[walls + static_cast<std::size_t>(column.freedom)] * column.velocity;
        }
        const Vec3& n = bond.normal;
        const double along = dot(velocity, n);
        const Vec3 drag = tangential * (velocity - along * n - cross(surface, n));
        const Vec3 f = normal * along * n + drag;
        const Vec3 turn = cross(drag, n);  // -(n x drag)
        const Vec3 roll = rolling * (turning - dot(turning, n) * n);
        push<clumped>(bond.first, f, bond.lever_first * turn + roll, force);
        if (bond.second >= 0) push<clumped>(bond.second, -f, bond.lever_second * turn - roll, force);
        for (std::int32_t c = bond.columns; c < bond.columns_end; ++c) {
            const Column& column = columns_[static_cast<std::size_t>(c)];
            force[walls + static_cast<std::size_t>(column.freedom)] -= dot(f, column.velocity);
        }
    }
}

StepShare Network::share(double time_step) const {
    if (bonds_.empty()) return {};
    const std::size_t spheres = inverse_mass_.size(), all = nodes();
    const auto n = static_cast<Eigen::Index>(size());
    const double of_springs = time_step * time_step, of_dampers = 2 * time_step;

    // Coordinates are scaled by the roots of their inertias, so that A becomes symmetric.
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(n), start = scale;
    const double heaviest = std::max(*std::ranges::max_element(load_), 1e-300);
    for (std::size_t i = 0; i < all; ++i) {
        // The fastest mode lies about the spheres with the stiffest contacts.
        const double relative = load_[i] / heaviest, weight = relative * relative * relative;
        if (weight == 0) continue;
        for (std::size_t k = 0; k < 6; ++k) {
            const auto at = static_cast<Eigen::Index>(6 * i + k);
            if (i < spheres)
                scale[at] = std::sqrt(k < 3 ? inverse_mass_[i] : inverse_inertia_[i]);
            else
                scale[at] =
                    std::sqrt(k < 3 ? bodies_[i - spheres].inverse_mass : 1 / bodies_[i - spheres].inertia[k - 3]);
            start[at] = weight * (2 * stats::to_unit(stats::splitmix64(6 * i + k)) - 1);
        }
    }
    for (std::size_t k = 0; k < freedoms_.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(6 * all + k);
        scale[at] = 1 / std::sqrt(freedoms_[k].inertia);
        start[at] = load_[all + k] / heaviest;
    }
    const auto applied = [&](double springs, double dampers, const Eigen::VectorXd& x) {
        const Eigen::VectorXd speeds = scale.cwiseProduct(x);
        Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
        if (bodies_.empty())
            apply<false>(springs, dampers, speeds.data(), force.data());
        else
            apply<true>(springs, dampers, speeds.data(), force.data());
        return Eigen::VectorXd(scale.cwiseProduct(force));
    };

    // Lanczos's iteration (Golub & Van Loan, Matrix Computations, 10.1); its largest eigenvalue grows to that of A.
    std::vector<Eigen::VectorXd> basis{start / start.norm()};
    std::vector<double> diagonal, beside;
    double largest = 0;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    const auto solve_small = [&](int wanted) {
        const auto count = static_cast<Eigen::Index>(diagonal.size());
        small.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), count),
                                     Eigen::Map<Eigen::VectorXd>(beside.data(), count - 1), wanted);
    };
    for (int k = 0; k < most_iterations; ++k) {
        Eigen::VectorXd next = applied(of_springs, of_dampers, basis.back());
        diagonal.push_back(next.dot(basis.back()));
        next -= diagonal.back() * basis.back();
        if (k > 0) next -= beside.back() * basis[static_cast<std::size_t>(k - 1)];
        solve_small(Eigen::EigenvaluesOnly);
        const double now = small.eigenvalues()[k];
        const double grown = now - largest;
        largest = now;
        const double left = next.norm();
        if ((k >= least_iterations && grown < converged * largest) || !(left > 1e-12 * largest)) break;
        if (k + 1 == most_iterations) break;
        beside.push_back(left);
        basis.push_back(next / left);
    }
    solve_small(Eigen::ComputeEigenvectors);
    const Eigen::VectorXd weights = small.eigenvectors().col(static_cast<Eigen::Index>(diagonal.size()) - 1);
    Eigen::VectorXd mode = Eigen::VectorXd::Zero(n);
    for (Eigen::Index k = 0; k < weights.size(); ++k) mode += weights[k] * basis[static_cast<std::size_t>(k)];
    mode /= mode.norm();

    // Both parts of the mode's eigenvalue give the step at which it reaches 4.
    const double springs = mode.dot(applied(of_springs, 0, mode)), dampers = mode.dot(applied(0, of_dampers, mode));
    StepShare found;
    // x = longest step / this one: springs x^2 + dampers x = 4
    found.share = (dampers + std::sqrt(dampers * dampers + 16 * springs)) / 8;
    double most = -1;
    for (std::size_t i = 0; i < all; ++i) {
        const double moved = mode.segment<6>(static_cast<Eigen::Index>(6 * i)).squaredNorm();
        if (moved > most)
            most = moved, found.sphere = i < spheres ? static_cast<std::int32_t>(i) : bodies_[i - spheres].first;
    }
    return found;
}

}  // namespace grainsweep::dem
