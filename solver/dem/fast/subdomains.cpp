#include "solver/dem/fast/subdomains.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/residual.hpp"
#include "solver/own_cores.hpp"

namespace grainsweep::dem::fast {

namespace {

/// Returns the tally before any contact.
Tally neutral_tally() {
    Tally t{};
    std::ranges::fill(t.velocity_high, -std::numeric_limits<float>::infinity());
    std::ranges::fill(t.velocity_low, std::numeric_limits<float>::infinity());
    return t;
}

}  // namespace

Field Subdomain::view(const Field& whole) const {
    Field f = whole;
    pairs.bind_pairs(f);
    f.begin = begin;
    f.end = end;
    f.filler = filler;
    f.outer_count = static_cast<std::int32_t>(ghost.size()) + row_end - row_begin;
    f.inner_count = inner_count;
    f.fetch_ahead = fetch_ahead;
    return f;
}

std::int32_t Subdomain::particle_at(Place place) const {
    const std::int32_t index = index_at(place);
    return index < filler ? index : partner[static_cast<std::size_t>(index - filler - 2)];
}

Place Subdomain::place_of(std::int32_t particle) const {
    if (particle >= begin && particle < end) return place_at(particle);
    const auto at = std::ranges::lower_bound(partner, particle) - partner.begin();
    return place_at(filler + 2 + static_cast<std::int32_t>(at));
}

void Subdomain::count_inner(const Field& view) {
    inner_count = view.inner_count;
    fetch_ahead = distance_to_fetch(view);
    const std::int32_t all = true_pairs(view);
    const auto ghosts = static_cast<std::int32_t>(ghost.size());
    inner_ghosts = static_cast<std::int32_t>(std::lower_bound(view.inner_source, view.inner_source + all, ghosts) -
                                             view.inner_source);
    inner_rows = all - inner_ghosts;
    std::ranges::fill(is_met, std::uint8_t{0});
    const auto look_at = [&](Place place) {
        if (place > place_at(filler + 1)) is_met[static_cast<std::size_t>(index_at(place) - filler - 2)] = 1;
    };
    for (std::int32_t k = 0; k < inner_ghosts; ++k) look_at(view.inner_first[k]);
    if (!leaving.empty()) {  // before the first of them, rows meet no copies
        const auto* const first_leaving = std::lower_bound(view.inner_source + inner_ghosts, view.inner_source + all,
                                                           leaving.front() - row_begin + ghosts);
        for (auto k = first_leaving - view.inner_source; k < all; ++k) look_at(view.inner_second[k]);
    }
    met.clear();
    met_here.clear();
    for (std::size_t k = 0; k < is_met.size(); ++k)
        if (is_met[k] != 0) {
            met.push_back(static_cast<std::int32_t>(k));
            met_here.push_back(partner[k]);
        }
}

std::int32_t Subdomain::touching_in(std::int32_t from, std::int32_t count, std::int32_t width) const {
    std::int32_t touching = 0;
    for (std::int32_t k = from; k < from + count; ++k) touching += bit_at(pairs.touching.data(), k, width) ? 1 : 0;
    return touching;
}

void Subdomain::copy_partners(Record* records, Mobility* mobility, bool all) const {
    const auto copy = [this, all](auto* column) {
        auto* const to = column + filler + 2;
        if (all)
            for (std::size_t k = 0; k < partner.size(); ++k) to[k] = column[partner[k]];
        else
            for (std::size_t k = 0; k < met.size(); ++k) to[met[k]] = column[met_here[k]];
    };
    copy(records);
    if (mobility != nullptr) copy(mobility);
}

std::span<const std::int32_t> Subdomain::own(const std::vector<std::int32_t>& particles) const {
    return {std::ranges::lower_bound(particles, begin), std::ranges::lower_bound(particles, end)};
}

void Subdomain::fetch_what_is_sent(Field& view, int turn) const {
    view.written_after = reinterpret_cast<const std::byte*>(sent[turn].data());
    view.lines_written_after =
        static_cast<std::int32_t>((sending.size() * sizeof(Kinematics) + cache_line - 1) / cache_line);
}

void Subdomain::send(const Record* records, int turn) const {
    Kinematics* row = sent[turn].data();
    for (const std::int32_t particle : sending) {
        const Record& r = records[particle];
        *row++ = {{r.position[0], r.position[1], r.position[2]},
                  {r.velocity[0], r.velocity[1], r.velocity[2]},
                  {r.spin[0], r.spin[1], r.spin[2]}};
    }
}

void Subdomains::use(Threads threads) {
    threads_ = threads;
    if (threads_.most <= 0) threads_.most = own_cores();
    threads_.least_particles = std::max(1, threads_.least_particles);
}

int Subdomains::wanted(std::int32_t particles) const {
    return std::clamp(static_cast<int>(particles / threads_.least_particles), 1, threads_.most);
}

Parts Subdomains::parts() const {
    if (subdomains_.empty()) return {};
    std::vector<PairColumns*> lists;
    for (const auto& subdomain : subdomains_) lists.push_back(&subdomain->pairs);
    return {*pool_, std::move(lists)};
}

void Subdomains::join(const Field& whole, const Columns& columns) const {
    if (subdomains_.empty() || joined_) return;
    const std::int32_t width = kernels_->width;
    const auto parts = static_cast<std::size_t>(count());
    std::vector<std::int32_t> pairs(parts + 1, 0), contacts(parts + 1, 0);
    pool_->run([&](int part) {
        const Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        contacts[static_cast<std::size_t>(part) + 1] = d.touching_in(d.inner_ghosts, d.inner_rows, width);
    });
    for (std::size_t k = 0; k < parts; ++k) {
        contacts[k + 1] += contacts[k];
        pairs[k + 1] = pairs[k] + subdomains_[k]->inner_rows;
    }
    pool_->run([&](int part) {
        const auto k = static_cast<std::size_t>(part);
        join_part(whole, part, pairs[k], contacts[k]);
    });
    const std::int32_t padded = fill_up(whole, pairs[parts], width);
    const std::int32_t vectors = (pairs[parts] + width - 1) / width,
                       cleared =
                           std::min((padded + spare) / 4 + 1, static_cast<std::int32_t>(columns.touching.capacity()));
    std::fill(whole.touching + vectors, whole.touching + std::max(vectors, cleared), std::uint16_t{0});
    // Vectors with pairs of several subdomains were left to the one that begins in them: here the others' bits.
    for (std::size_t k = 0; k < parts; ++k) {
        const Subdomain& d = *subdomains_[k];
        const std::int32_t end = std::min(pairs[k + 1], (pairs[k] + width - 1) / width * width);
        for (std::int32_t n = pairs[k]; n < end; ++n)
            if (bit_at(d.pairs.touching.data(), d.inner_ghosts + n - pairs[k], width))
                set_bit(whole.touching, n, width);
    }
    joined_ = true;
}

/// Writes the inner list's rows of a subdomain to the whole list from number `n` on, its contacts from `contacts` on.
/// Touching pairs are marked in the vectors that begin with one of its pairs.
void Subdomains::join_part(const Field& whole, int part, std::int32_t n, std::int32_t contacts) const {
    const Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
    const std::int32_t width = kernels_->width;
    const Field f = d.view(whole);
    const auto ghosts = static_cast<std::int32_t>(d.ghost.size());
    const std::int32_t marked = (n + width - 1) / width * width;
    for (std::int32_t k = d.inner_ghosts; k < d.inner_ghosts + d.inner_rows; ++k, ++n) {
        whole.inner_first[n] = f.inner_first[k];
        whole.inner_second[n] = place_at(d.particle_at(f.inner_second[k]));
        whole.inner_reach[n] = f.inner_reach[k];
        whole.inner_source[n] = d.row_begin + f.inner_source[k] - ghosts;
        if (n < marked) continue;
        if (n % width == 0) whole.touching[n / width] = 0;
        if (bit_at(f.touching, k, width)) set_bit(whole.touching, n, width);
    }
    const std::int32_t before = d.touching_in(0, d.inner_ghosts, width),
                       of_rows = d.touching_in(d.inner_ghosts, d.inner_rows, width);
    for (int a = 0; a < f.histories; ++a) std::copy_n(f.history[a] + before, of_rows, whole.history[a] + contacts);
}

/// After every subdomain has found what it meets.
void Subdomains::find_what_to_send(int part) const {
    Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
    d.sending.clear();
    d.sending_to.assign(1, 0);
    for (const auto& to : subdomains_) {
        const std::span<const std::int32_t> met = d.own(to->met_here);
        d.sending.insert(d.sending.end(), met.begin(), met.end());
        d.sending_to.push_back(static_cast<std::int32_t>(d.sending.size()));
    }
}

/// Brings the copies that a sweep of this part meets up to date with what the others have sent.
void Subdomains::receive(const Field& whole, int part) const {
    const auto to = static_cast<std::size_t>(part);
    const Subdomain& d = *subdomains_[to];
    const std::int32_t* met = d.met.data();  // ascending: rows of the first subdomain, of the second ...
    for (const auto& from : subdomains_)
        for (std::int32_t k = from->sending_to[to]; k < from->sending_to[to + 1]; ++k) {
            const Kinematics& moved = from->sent[turn_].data()[k];
            const std::int32_t copy = d.filler + 2 + *met++;
            Record& r = whole.records[copy];
            for (int a = 0; a < 3; ++a) {
                r.position[a] = moved.position[a];
                r.velocity[a] = moved.velocity[a];
                set_spin(whole, copy, a, moved.spin[a]);
            }
        }
}

void Subdomains::sweep(Field& whole, std::optional<Refresh> renewal, bool goes_on, bool advance, bool keep,
                       Tally& tally) {
    const bool received = goes_on && !renewal;
    if (!received)
        pool_->run([&](int part) {
            subdomains_[static_cast<std::size_t>(part)]->copy_partners(whole.records, whole.mobility,
                                                                       renewal.has_value());
        });
    pool_->run_timed([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        if (received) receive(whole, part);
        Field f = d.view(whole);
        if (advance) d.fetch_what_is_sent(f, 1 - turn_);
        if (renewal) {
            refresh(f, d.pairs, *kernels_, renewal->skin, renewal->marked);
            d.count_inner(f);
        }
        d.tally = neutral_tally();
        kernels_->sweep(f, advance, d.tally);
        if (!keep) d.pairs.swap_histories(f);
        if (advance && !renewal) d.send(whole.records, 1 - turn_);
    });
    if (renewal) {
        pool_->run([&](int part) {  // what each meets is known only now
            find_what_to_send(part);
            if (advance) subdomains_[static_cast<std::size_t>(part)]->send(whole.records, 1 - turn_);
        });
        std::int32_t pairs = 0;
        for (const auto& subdomain : subdomains_) pairs += subdomain->inner_rows;
        whole.inner_count = (pairs + kernels_->width - 1) / kernels_->width * kernels_->width;
    }
    turn_ = 1 - turn_;
    merge(tally);
    joined_ = false;
}

void Subdomains::advance(const Field& whole, Tally& tally) {
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        d.tally = neutral_tally();
        kernels_->advance(d.view(whole), d.tally);
    });
    merge(tally);
}

/// Adds what the subdomains met, in their order; of two equal extremes the earlier stays, as in a sweep over all.
void Subdomains::merge(Tally& tally) const {
    for (const auto& subdomain : subdomains_) {
        const Tally& t = subdomain->tally;
        for (int a = 0; a < 8; ++a) {
            if (t.velocity_high[a] > tally.velocity_high[a]) tally.velocity_high[a] = t.velocity_high[a];
            if (t.velocity_low[a] < tally.velocity_low[a]) tally.velocity_low[a] = t.velocity_low[a];
        }
        tally.overlap = std::max(tally.overlap, t.overlap);
    }
}

}  // namespace grainsweep::dem::fast
