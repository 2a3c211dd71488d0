#include "solver/particles/packing.hpp"

#include "stats/random.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace grainsweep::particles {
namespace {

// Four lanes of 32 bits: x, y, z and nothing. The compilers' vector types use the baseline instruction set,
// so the bits are the same on every processor.
using Fixed = std::uint32_t __attribute__((vector_size(16)));
using Offset = std::int32_t __attribute__((vector_size(16)));
using Real = float __attribute__((vector_size(16)));

constexpr std::uint64_t first_points = 0x7061636B;  // the random stream that places them
constexpr double turn = 4294967296.0;               // grid steps per edge

float dot_of(const Real& a, const Real& b) {
    const Real product = a * b;
    return product[0] + product[1] + product[2];
}

/// FIRE's published constants, in units of the contact time (unit mass and stiffness).
namespace fire {
constexpr float first_step = 0.1F, longest_step = 0.6F, longest_move = 0.1F;
constexpr float grow = 1.1F, shrink = 0.5F, mix = 0.1F, mix_decay = 0.99F;
constexpr int patience = 5;
constexpr int most_iterations = 20'000;
}  // namespace fire

class Relaxation {
public:
    explicit Relaxation(const PackingRequest& request);
    Packing relax();

private:
    void sort_into_cells();
    void list_pairs();
    [[nodiscard]] std::array<std::size_t, 14> cells_ahead(std::int32_t x, std::int32_t y, std::int32_t z) const;
    float apply_forces();
    void choose_step();
    void move_downhill();
    [[nodiscard]] double overlap_in_double() const;
    [[nodiscard]] Packing result() const;
    [[nodiscard]] Real between(const Fixed& a, const Fixed& b) const {
        return __builtin_convertvector(std::bit_cast<Offset>(a - b), Real) * unit_;  // wraps to the nearest image
    }

    PackingRequest request_;
    float unit_;  // diameters per grid step
    std::vector<Fixed> position_, listed_position_;
    std::vector<Real> velocity_, force_;
    float skin_ = 0.3F;
    std::int32_t cells_ = 0;                 // per edge
    std::vector<std::uint32_t> cell_of_;     // particle -> cell
    std::vector<std::uint32_t> cell_first_;  // cell -> its first particle; particles lie in cell order
    std::vector<std::uint32_t> pair_first_, partner_;

    float step_ = fire::first_step, mix_ = fire::mix;
    int downhill_ = 0, iterations_ = 0;
    float keep_ = 0, push_ = 0;  // v := keep v + push f
    float longest_move_ = 0;     // of the last step, diameters
    float farthest_ = 0;         // from where the pairs were listed, diameters
};

Relaxation::Relaxation(const PackingRequest& request)
    : request_(request), unit_(static_cast<float>(request.edge / turn)) {
    const auto count = static_cast<std::size_t>(sphere_count(request));
    const stats::Stream points(request.seed, first_points);
    position_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) position_[i][k] = static_cast<std::uint32_t>(points.bits(3 * i + k) >> 32U);
    velocity_.assign(count, Real{});
    force_.assign(count, Real{});
}

/// Puts the particles in the order of cells at least one list range wide, x fastest.
void Relaxation::sort_into_cells() {
    cells_ = static_cast<std::int32_t>(request_.edge / (1 + static_cast<double>(skin_)));
    const auto cells = static_cast<std::uint64_t>(cells_);
    const auto along = [cells](std::uint32_t x) { return (x * cells) >> 32U; };
    cell_of_.resize(position_.size());
    cell_first_.assign(cells * cells * cells + 1, 0);
    for (std::size_t i = 0; i < position_.size(); ++i) {
        const Fixed& x = position_[i];
        cell_of_[i] = static_cast<std::uint32_t>((along(x[2]) * cells + along(x[1])) * cells + along(x[0]));
        ++cell_first_[cell_of_[i] + 1];
    }
    std::partial_sum(cell_first_.begin(), cell_first_.end(), cell_first_.begin());
    std::vector<std::uint32_t> next(cell_first_.begin(), cell_first_.end() - 1);
    std::vector<Fixed> position(position_.size());
    std::vector<Real> velocity(position_.size());
    for (std::size_t i = 0; i < position_.size(); ++i) {
        const std::uint32_t place = next[cell_of_[i]]++;
        position[place] = position_[i];
        velocity[place] = velocity_[i];
    }
    position_.swap(position);
    velocity_.swap(velocity);
}

/// The cell itself and the 13 after it: every pair of neighbouring cells is met once.
std::array<std::size_t, 14> Relaxation::cells_ahead(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const auto wrap = [this](std::int32_t c) { return c < 0 ? c + cells_ : (c >= cells_ ? c - cells_ : c); };
    const auto at = [&](std::int32_t cx, std::int32_t cy, std::int32_t cz) {
        return static_cast<std::size_t>((wrap(cz) * cells_ + wrap(cy)) * cells_ + wrap(cx));
    };
    std::array<std::size_t, 14> ahead{at(x, y, z), at(x + 1, y, z)};
    std::size_t known = 2;
    for (std::int32_t dx = -1; dx <= 1; ++dx) ahead[known++] = at(x + dx, y + 1, z);
    for (std::int32_t dy = -1; dy <= 1; ++dy)
        for (std::int32_t dx = -1; dx <= 1; ++dx) ahead[known++] = at(x + dx, y + dy, z + 1);
    return ahead;
}

/// Lists every pair closer than 1 + skin once.
void Relaxation::list_pairs() {
    sort_into_cells();
    const float range = 1 + skin_;
    pair_first_.assign(1, 0);
    partner_.clear();
    const auto add_partners = [&](std::uint32_t i, std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t j = first; j < end; ++j) {
            const Real d = between(position_[i], position_[j]);
            if (dot_of(d, d) < range * range) partner_.push_back(j);
        }
    };
    for (std::int32_t z = 0; z < cells_; ++z)
        for (std::int32_t y = 0; y < cells_; ++y)
            for (std::int32_t x = 0; x < cells_; ++x) {
                const auto ahead = cells_ahead(x, y, z);
                for (std::uint32_t i = cell_first_[ahead[0]]; i < cell_first_[ahead[0] + 1]; ++i) {
                    add_partners(i, i + 1, cell_first_[ahead[0] + 1]);
                    for (std::size_t c = 1; c < ahead.size(); ++c)
                        add_partners(i, cell_first_[ahead[c]], cell_first_[ahead[c] + 1]);
                    pair_first_.push_back(static_cast<std::uint32_t>(partner_.size()));
                }
            }
    listed_position_ = position_;
}

/// Forces of the overlap energy; returns the largest overlap.
float Relaxation::apply_forces() {
    std::ranges::fill(force_, Real{});
    float largest = 0;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        const Fixed here = position_[i];
        Real total{};
        for (std::uint32_t k = pair_first_[i]; k < pair_first_[i + 1]; ++k) {
            const std::uint32_t j = partner_[k];
            const Real d = between(here, position_[j]);
            const float r = std::sqrt(std::max(dot_of(d, d), 1e-12F));
            const float overlap = std::max(1 - r, 0.0F);
            const Real push = d * (overlap / r);
            total += push;
            force_[j] -= push;
            largest = std::max(largest, overlap);
        }
        force_[i] += total;
    }
    return largest;
}

/// FIRE's rule: go on and faster while the power is positive, else stop and start anew with a shorter step.
void Relaxation::choose_step() {
    double power = 0, speed_square = 0, force_square = 0;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        power += static_cast<double>(dot_of(force_[i], velocity_[i]));
        speed_square += static_cast<double>(dot_of(velocity_[i], velocity_[i]));
        force_square += static_cast<double>(dot_of(force_[i], force_[i]));
    }
    if (power > 0) {
        keep_ = 1 - mix_;
        push_ = mix_ * static_cast<float>(std::sqrt(speed_square / force_square));
        if (++downhill_ > fire::patience) {
            step_ = std::min(step_ * fire::grow, fire::longest_step);
            mix_ *= fire::mix_decay;
        }
    } else {
        keep_ = 0;
        push_ = 0;
        step_ *= fire::shrink;
        mix_ = fire::mix;
        downhill_ = 0;
    }
    push_ += step_;
}

/// One step of semi-implicit Euler; no particle moves farther than the longest move allowed.
void Relaxation::move_downhill() {
    const float to_grid = 1 / unit_;
    float longest_square = 0, farthest_square = 0;
    for (std::size_t i = 0; i < position_.size(); ++i) {
        Real v = velocity_[i] * keep_ + force_[i] * push_;
        Real move = v * step_;
        float square = dot_of(move, move);
        if (square > fire::longest_move * fire::longest_move) {
            const float shorter = fire::longest_move / std::sqrt(square);
            v *= shorter;
            move *= shorter;
            square = fire::longest_move * fire::longest_move;
        }
        velocity_[i] = v;
        position_[i] += std::bit_cast<Fixed>(__builtin_convertvector(move * to_grid, Offset));
        const Real from_listed = between(position_[i], listed_position_[i]);
        longest_square = std::max(longest_square, square);
        farthest_square = std::max(farthest_square, dot_of(from_listed, from_listed));
    }
    longest_move_ = std::sqrt(longest_square);
    farthest_ = std::sqrt(farthest_square);
    ++iterations_;
}

double Relaxation::overlap_in_double() const {
    const double unit = request_.edge / turn;
    double largest = 0;
    for (std::size_t i = 0; i < position_.size(); ++i)
        for (std::uint32_t k = pair_first_[i]; k < pair_first_[i + 1]; ++k) {
            const Offset d = std::bit_cast<Offset>(position_[i] - position_[partner_[k]]);
            largest = std::max(largest, 1 - unit * std::hypot(static_cast<double>(d[0]), static_cast<double>(d[1]),
                                                              static_cast<double>(d[2])));
        }
    return largest;
}

Packing Relaxation::result() const {
    Packing packing{request_.edge, {}, overlap_in_double(), iterations_};
    packing.positions.resize(position_.size());
    for (std::size_t i = 0; i < position_.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            packing.positions[i][k] = static_cast<double>(position_[i][k]) * (request_.edge / turn);
    return packing;
}

Packing Relaxation::relax() {
    list_pairs();
    const auto tolerance = static_cast<float>(request_.tolerance);
    while (apply_forces() >= tolerance) {
        if (iterations_ == fire::most_iterations)
            throw std::invalid_argument("a packing of volume fraction " + std::to_string(request_.fraction) +
                                        " still overlaps after " + std::to_string(iterations_) +
                                        " steps: ask for a smaller fraction");
        choose_step();
        move_downhill();
        if (2 * farthest_ >= skin_) {
            // A list as narrow as the motion allows: the calmer the particles, the fewer pairs to visit.
            skin_ = std::clamp(20 * longest_move_, 0.04F, 0.3F);
            list_pairs();
        }
    }
    return result();
}

}  // namespace

std::int64_t sphere_count(const PackingRequest& request) {
    return std::llround(6 * request.fraction * request.edge * request.edge * request.edge / std::numbers::pi);
}

Packing random_close_packing(const PackingRequest& request) {
    if (!(request.edge >= 5 && request.edge <= 400))
        throw std::invalid_argument("the edge of a packing is 5 to 400 diameters");
    if (!(request.fraction >= 0.05 && request.fraction <= 0.635))
        throw std::invalid_argument("the volume fraction of a packing is 0.05 to 0.635");
    if (!(request.tolerance >= 5e-6))
        throw std::invalid_argument("the overlap tolerance of a packing is at least 5e-6");
    return Relaxation(request).relax();
}

}  // namespace grainsweep::particles
