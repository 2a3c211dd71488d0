#include "solver/dem/network.hpp"

#include "stats/random.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::dem {

using namespace geometry;

namespace {

constexpr int most_iterations = 20;
constexpr int least_iterations = 6;
constexpr double converged = 5e-3;  ///< relative growth of the eigenvalue per iteration
constexpr double stiffest = 0.7;    ///< share of the largest sum of loads of the contacts about which a mode is sought
constexpr std::int32_t rings = 2;   ///< of contacts about those

Vec3 at(const double* x) {
    return {x[0], x[1], x[2]};
}

void add_to(double* x, const Vec3& a) {
    for (std::size_t k = 0; k < 3; ++k) x[k] += a[k];
}

}  // namespace

/// Springs and dampers of a contact, weighted.
struct Network::Weighted {
    double normal, tangential, rolling;

    Weighted(const Springs& s, double of_springs, double of_dampers)
        : normal(of_springs * s.normal + of_dampers * s.normal_damper),
          tangential(of_springs * s.tangential + of_dampers * s.tangential_damper),
          rolling(of_springs * s.rolling + of_dampers * s.rolling_damper) {}
    /// Returns the largest eigenvalue of the contact between fixed masses of 1 with the inertia of spheres.
    [[nodiscard]] double strength(const Bond& bond) const {
        const double lever = std::max(bond.lever_first, bond.lever_second);
        return std::max(normal, 3.5 * tangential + 2.5 * rolling / (lever * lever));
    }
};

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
    const double* const x = speeds + place_of<clumped>(sphere);
    if (by == nullptr) return {at(x), at(x + 3)};
    const Vec3 turning = in_space(bodies_[static_cast<std::size_t>(by->body)].axes, at(x + 3));
    return {at(x) + cross(turning, by->lever), turning};
}

template <bool clumped>
void Network::push(std::int32_t sphere, const Vec3& force, const Vec3& moment, double* forces) const {
    const Carrier* const by = clumped ? carrier(sphere) : nullptr;
    double* const x = forces + place_of<clumped>(sphere);
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
        const double s = w.strength(bond);
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
    for (const Bond& bond : bonds_) largest = std::max(largest, load_at(bond));
    return largest;
}

double Network::load_at(const Bond& bond) const {
    double sum = load_[node_of(bond.first)];
    if (bond.second >= 0) sum += load_[node_of(bond.second)];
    for (std::int32_t c = bond.columns; c < bond.columns_end; ++c)
        sum += load_[nodes() + static_cast<std::size_t>(columns_[static_cast<std::size_t>(c)].freedom)];
    return sum;
}

void Network::find_part() const {
    double largest = 0;
    for (const Bond& bond : bonds_) largest = std::max(largest, load_at(bond));
    // Distance of each node from the stiffest contacts, in contacts.
    constexpr std::int32_t far = rings + 1;
    places_.assign(nodes(), far);
    const auto nearest = [&](const Bond& bond) {
        std::int32_t& first = places_[node_of(bond.first)];
        return std::pair<std::int32_t&, std::int32_t&>(first, bond.second < 0 ? first : places_[node_of(bond.second)]);
    };
    for (const Bond& bond : bonds_)
        if (load_at(bond) >= stiffest * largest) {
            const auto [first, second] = nearest(bond);
            first = second = 0;
        }
    for (std::int32_t ring = 1; ring <= rings; ++ring)
        for (const Bond& bond : bonds_) {
            const auto [first, second] = nearest(bond);
            if (first == ring - 1) second = std::min(second, ring);
            if (second == ring - 1) first = std::min(first, ring);
        }
    part_.clear();
    for (std::size_t b = 0; b < bonds_.size(); ++b) {
        const auto [first, second] = nearest(bonds_[b]);
        if (first < far && second < far) part_.push_back(static_cast<std::uint32_t>(b));
    }
    in_part_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const bool inside = std::exchange(places_[i], -1) < far;
        if (!inside) continue;
        places_[i] = static_cast<std::int32_t>(in_part_.size());
        in_part_.push_back(i);
    }
}

template <bool clumped>
Network::Relative Network::relative(const Bond& bond, const double* speeds) const {
    auto [velocity, turning] = motion_of<clumped>(bond.first, speeds);
    Vec3 surface = bond.lever_first * turning;
    if (bond.second >= 0) {
        const Moved other = motion_of<clumped>(bond.second, speeds);
        velocity = velocity - other.velocity;
        turning = turning - other.turning;
        surface += bond.lever_second * other.turning;
    }
    const std::size_t walls = 6 * in_part_.size();
    for (std::int32_t c = bond.columns; c < bond.columns_end; ++c) {
        const Column& column = columns_[static_cast<std::size_t>(c)];
        velocity = velocity - speeds[walls + static_cast<std::size_t>(column.freedom)] * column.velocity;
    }
    const Vec3& n = bond.normal;
    const double along = dot(velocity, n);
    return {along, velocity - along * n - cross(surface, n), turning - dot(turning, n) * n};
}

template <bool clumped>
void Network::apply(const std::vector<Weighted>& weighted, const double* speeds, double* force) const {
    const std::size_t walls = 6 * in_part_.size();
    for (std::size_t b = 0; b < part_.size(); ++b) {
        const Bond& bond = bonds_[part_[b]];
        const auto [along, sliding, rolling] = relative<clumped>(bond, speeds);
        const Vec3& n = bond.normal;
        const Vec3 drag = weighted[b].tangential * sliding;
        const Vec3 f = weighted[b].normal * along * n + drag;
        const Vec3 turn = cross(drag, n);  // -(n x drag)
        const Vec3 roll = weighted[b].rolling * rolling;
        push<clumped>(bond.first, f, bond.lever_first * turn + roll, force);
        if (bond.second >= 0) push<clumped>(bond.second, -f, bond.lever_second * turn - roll, force);
        for (std::int32_t c = bond.columns; c < bond.columns_end; ++c) {
            const Column& column = columns_[static_cast<std::size_t>(c)];
            force[walls + static_cast<std::size_t>(column.freedom)] -= dot(f, column.velocity);
        }
    }
}

template <bool clumped>
Network::Energies Network::energies(double of_springs, double of_dampers, const double* speeds) const {
    Energies e;
    for (const std::uint32_t b : part_) {
        const Bond& bond = bonds_[b];
        const auto [along, sliding, rolling] = relative<clumped>(bond, speeds);
        const double normal = along * along, tangential = dot(sliding, sliding), turned = dot(rolling, rolling);
        const Springs& s = bond.springs;
        e.springs += s.normal * normal + s.tangential * tangential + s.rolling * turned;
        e.dampers += s.normal_damper * normal + s.tangential_damper * tangential + s.rolling_damper * turned;
    }
    return {of_springs * e.springs, of_dampers * e.dampers};
}

StepShare Network::share(double time_step) const {
    if (bonds_.empty()) return {};
    find_part();
    const std::size_t spheres = inverse_mass_.size(), count = in_part_.size();
    const auto n = static_cast<Eigen::Index>(6 * count + freedoms_.size());
    const double of_springs = time_step * time_step, of_dampers = 2 * time_step;

    // Coordinates are scaled by the roots of their inertias, so that A becomes symmetric.
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(n), start = scale;
    const double heaviest = std::max(*std::ranges::max_element(load_), 1e-300);
    for (std::size_t p = 0; p < count; ++p) {
        const std::size_t i = in_part_[p];
        // The fastest mode lies about the spheres with the stiffest contacts.
        const double relative = load_[i] / heaviest, weight = relative * relative * relative;
        if (weight == 0) continue;
        for (std::size_t k = 0; k < 6; ++k) {
            const auto at = static_cast<Eigen::Index>(6 * p + k);
            if (i < spheres)
                scale[at] = std::sqrt(k < 3 ? inverse_mass_[i] : inverse_inertia_[i]);
            else
                scale[at] =
                    std::sqrt(k < 3 ? bodies_[i - spheres].inverse_mass : 1 / bodies_[i - spheres].inertia[k - 3]);
            start[at] = weight * (2 * stats::to_unit(stats::splitmix64(6 * i + k)) - 1);
        }
    }
    for (std::size_t k = 0; k < freedoms_.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(6 * count + k);
        scale[at] = 1 / std::sqrt(freedoms_[k].inertia);
        start[at] = load_[nodes() + k] / heaviest;
    }
    std::vector<Weighted> weighted;
    weighted.reserve(part_.size());
    for (const std::uint32_t b : part_) weighted.emplace_back(bonds_[b].springs, of_springs, of_dampers);
    const auto applied = [&](const Eigen::VectorXd& x) {
        const Eigen::VectorXd speeds = scale.cwiseProduct(x);
        Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
        if (bodies_.empty())
            apply<false>(weighted, speeds.data(), force.data());
        else
            apply<true>(weighted, speeds.data(), force.data());
        return Eigen::VectorXd(scale.cwiseProduct(force));
    };

    // Lanczos's iteration (Golub & Van Loan, Matrix Computations, 10.1); its largest eigenvalue grows to that of A.
    std::vector<Eigen::VectorXd> basis{start / start.norm()};
    std::vector<double> diagonal, beside;
    double largest = 0;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    const auto solve_small = [&](int wanted) {
        const auto order = static_cast<Eigen::Index>(diagonal.size());
        small.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), order),
                                     Eigen::Map<Eigen::VectorXd>(beside.data(), order - 1), wanted);
    };
    for (int k = 0; k < most_iterations; ++k) {
        Eigen::VectorXd next = applied(basis.back());
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
    const Eigen::VectorXd speeds = scale.cwiseProduct(mode);
    const auto [springs, dampers] = bodies_.empty() ? energies<false>(of_springs, of_dampers, speeds.data())
                                                    : energies<true>(of_springs, of_dampers, speeds.data());
    StepShare found;
    // x = longest step / this one: springs x^2 + dampers x = 4
    found.share = (dampers + std::sqrt(dampers * dampers + 16 * springs)) / 8;
    double most = -1;
    for (std::size_t p = 0; p < count; ++p) {
        const std::size_t i = in_part_[p];
        const double moved = mode.segment<6>(static_cast<Eigen::Index>(6 * p)).squaredNorm();
        if (moved > most)
            most = moved, found.sphere = i < spheres ? static_cast<std::int32_t>(i) : bodies_[i - spheres].first;
    }
    return found;
}

}  // namespace grainsweep::dem
