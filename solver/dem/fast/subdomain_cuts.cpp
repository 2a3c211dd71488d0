#include <algorithm>
#include <bit>
#include <numeric>
#include <span>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/subdomains.hpp"

namespace grainsweep::dem::fast {

namespace {

// Relative costs in a sweep of an advanced particle, a contact, and a pair that is only listed. A pair with a row of
// another subdomain has an additional cost: its particles are read out of order.
constexpr double cost_of_particle = 4, cost_of_contact = 5, cost_of_pair = 0.3, cost_of_waiting = 1.5;

// Timings of fewer sweeps show chance rather than the speed of cores.
constexpr int sweeps_that_tell = 64;

// Most of the time of the first cut is spent on allocating memory.
constexpr double share_without_memory = 0.2;

}  // namespace

std::int32_t Subdomains::contacts_before(const Field& whole, std::int32_t pair) const {
    const std::int32_t width = kernels_->width, rest = pair % width;
    const auto vector = static_cast<std::size_t>(pair / width);
    const unsigned before = rest == 0 ? 0 : whole.outer_touching[vector] & ((1U << static_cast<unsigned>(rest)) - 1);
    return contacts_before_[vector] + std::popcount(before);
}

bool Subdomains::uneven() const {
    if (!cut()) return false;
    const std::vector<double> seconds = pool_->seconds(sweeps_that_tell);
    if (seconds.empty()) return false;
    const double mean = std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(seconds.size());
    const double waited = std::ranges::max(seconds) - mean;
    return static_cast<double>(pool_->timed_rounds()) * waited > 2 * cut_seconds_;  // lists are joined before
}

void Subdomains::mark_touching(const Field& whole, Columns& columns) const {
    const std::int32_t width = kernels_->width;
    columns.outer_touching.clear(static_cast<std::size_t>(whole.outer_count / width) + 2);
    for (std::int32_t k = 0; k < whole.inner_count; ++k)
        if (bit_at(whole.touching, k, width)) set_bit(whole.outer_touching, whole.inner_source[k], width);
}

void Subdomains::cut_up(Field& whole, Columns& columns, bool listed) {
    const int parts = wanted(whole.count);
    if (parts == 1) {
        subdomains_.clear();
        pool_.reset();
        return;
    }
    subdomains_.resize(static_cast<std::size_t>(parts));  // those there are keep their memory
    for (auto& subdomain : subdomains_)
        if (subdomain == nullptr) subdomain = std::make_unique<Subdomain>();
    const bool first = pool_ == nullptr || pool_->size() != parts;
    if (first) {
        pool_ = std::make_unique<ThreadPool>(parts);
        shares_ = Shares(parts);
    } else {
        shares_.move(pool_->seconds(sweeps_that_tell));
        pool_->forget_times();
    }
    const double start = ThreadPool::clock_seconds();
    const std::int32_t width = kernels_->width;
    const std::int32_t vectors = whole.outer_count / width + 1;
    if (listed) mark_touching(whole, columns);
    contacts_before_.resize(static_cast<std::size_t>(vectors) + 1);
    std::int32_t contacts = 0;
    for (std::int32_t b = 0; b <= vectors; ++b) {
        contacts_before_[static_cast<std::size_t>(b)] = contacts;
        contacts += std::popcount(static_cast<unsigned>(b < vectors ? whole.outer_touching[b] : 0));
    }
    choose_ranges(whole, columns);
    find_partners(whole);
    place_copies(whole, columns);
    for (const auto& d : subdomains_) {
        d->pairs.histories = columns.histories;
        d->is_met.resize(d->partner.size());
        d->met.reserve(d->partner.size());
        d->met_here.reserve(d->partner.size());
        std::size_t sending = 0;
        for (const auto& to : subdomains_) sending += d->own(to->partner).size();
        d->sending.clear();
        d->sending.reserve(sending);
        for (auto& rows : d->sent) rows.hold(sending);
        d->pairs.hold_pairs(d->ghost.size() + static_cast<std::size_t>(d->row_end - d->row_begin) + 2 * tile);
    }
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        fill(d, whole);
        if (listed) fill_inner(d, whole);
    });
    if (listed) pool_->run([this](int part) { find_what_to_send(part); });
    joined_ = true;
    cut_seconds_ = ThreadPool::clock_seconds() - start;
    if (first) cut_seconds_ *= share_without_memory;
}

/// Chooses ranges that need about the same time. Pairs across subdomains are computed in both. The cost of a
/// subdomain's pairs with earlier subdomains depends little on the exact start of its range. So this cost is computed
/// for ranges that were chosen without it.
void Subdomains::choose_ranges(const Field& whole, const Columns& columns) {
    for (const auto& subdomain : subdomains_) subdomain->ghost_cost = 0;
    set_ranges(whole, columns);
    find_crossing_pairs(whole);
    for (const auto& subdomain : subdomains_)
        for (const std::int32_t o : subdomain->ghost)
            subdomain->ghost_cost += cost_of_pair + cost_of_waiting +
                                     (bit_at(whole.outer_touching, o, kernels_->width) ? cost_of_contact : 0);
    set_ranges(whole, columns);
    find_crossing_pairs(whole);
}

/// Sets ranges whose costs are proportional to the shares of their threads, with the present costs of ghosts.
void Subdomains::set_ranges(const Field& whole, const Columns& columns) {
    const int parts = count();
    const auto cost_before = [&](std::int32_t particle) {
        const std::int32_t pairs = pairs_before(whole.outer_first, whole.outer_count, particle);
        const std::int32_t advanced =
            whole.skips != 0 ? columns.advanced_before[static_cast<std::size_t>(particle)] : particle;
        return cost_of_particle * advanced + cost_of_contact * contacts_before(whole, pairs) + cost_of_pair * pairs;
    };
    double total = cost_before(whole.count), share = 0;
    for (const auto& subdomain : subdomains_) total += subdomain->ghost_cost;
    std::int32_t begin = 0;
    for (int part = 0; part < parts; ++part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        std::int32_t low = begin, high = whole.count;
        share += total * shares_.of(part) - d.ghost_cost;
        while (part + 1 < parts && low < high) {
            const std::int32_t middle = low + (high - low) / 2;
            if (cost_before(middle) < share)
                low = middle + 1;
            else
                high = middle;
        }
        d.begin = begin;
        d.end = begin = high;
        d.row_begin = pairs_before(whole.outer_first, whole.outer_count, d.begin);
        d.row_end = pairs_before(whole.outer_first, whole.outer_count, d.end);
    }
}

void Subdomains::find_crossing_pairs(const Field& whole) {
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        d.leaving.clear();
        for (std::int32_t o = d.row_begin; o < d.row_end; ++o)
            if (whole.outer_second[o] >= place_at(d.end)) d.leaving.push_back(o);
    });
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        d.ghost.clear();
        for (int earlier = 0; earlier < part; ++earlier)
            for (const std::int32_t o : subdomains_[static_cast<std::size_t>(earlier)]->leaving) {
                const std::int32_t second = index_at(whole.outer_second[o]);
                if (second >= d.begin && second < d.end) d.ghost.push_back(o);
            }
    });
}

/// The particles that pairs across subdomains need of other subdomains.
void Subdomains::find_partners(const Field& whole) {
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        d.partner.clear();
        for (const std::int32_t o : d.leaving) d.partner.push_back(index_at(whole.outer_second[o]));
        for (const std::int32_t o : d.ghost) d.partner.push_back(index_at(whole.outer_first[o]));
        std::ranges::sort(d.partner);
        const auto again = std::ranges::unique(d.partner);
        d.partner.erase(again.begin(), again.end());
    });
}

/// Makes room for the copies behind the particles.
void Subdomains::place_copies(Field& whole, Columns& columns) {
    const auto even = [](std::size_t n) { return n + n % 2; };  // two forces share a cache line
    std::size_t next = even(static_cast<std::size_t>(whole.count) + fillers);
    for (const auto& subdomain : subdomains_) {
        subdomain->filler = static_cast<std::int32_t>(next);
        next = even(next + 2 + subdomain->partner.size());
    }
    columns.records.hold(next + spare);
    columns.kind.hold(next + spare);
    if (columns.member.capacity() > 0) columns.member.hold(next + spare), columns.mobility.hold(next + spare);
    columns.forces.hold(next + spare);
    columns.bind(whole);
    for (const auto& subdomain : subdomains_) {
        for (std::int32_t k = 0; k < 2; ++k) {
            whole.records[subdomain->filler + k] = whole.records[whole.filler + k];
            if (whole.member == nullptr) continue;
            whole.member[subdomain->filler + k] = -1;
            whole.mobility[subdomain->filler + k] = whole.mobility[whole.filler + k];
        }
        // What a partner keeps until the next cuts: lists may be taken over without new inner ones.
        std::int32_t copy = subdomain->filler + 2;
        for (const std::int32_t partner : subdomain->partner) {
            whole.kind[copy] = whole.kind[partner];
            if (whole.member != nullptr) whole.member[copy] = whole.member[partner];
            ++copy;
        }
    }
}

/// The outer list of a subdomain, which of its pairs touch, and their histories.
void Subdomains::fill(Subdomain& d, const Field& whole) const {
    const std::int32_t width = kernels_->width, rows = d.row_end - d.row_begin;
    const auto ghosts = static_cast<std::int32_t>(d.ghost.size());
    const Field f = d.view(whole);
    d.pairs.outer_touching.clear(static_cast<std::size_t>((ghosts + rows) / width) + 2);
    const auto take = [&](std::int32_t to, std::int32_t from) {
        f.outer_first[to] = d.place_of(index_at(whole.outer_first[from]));
        f.outer_second[to] = whole.outer_second[from] >= place_at(d.end)
                                 ? d.place_of(index_at(whole.outer_second[from]))
                                 : whole.outer_second[from];
        f.outer_reach[to] = whole.outer_reach[from];
        const bool touches = bit_at(whole.outer_touching, from, width);
        if (touches) set_bit(f.outer_touching, to, width);
        return touches;
    };
    std::int32_t contact = 0;
    for (std::int32_t k = 0; k < ghosts; ++k) {
        const std::int32_t o = d.ghost[static_cast<std::size_t>(k)];
        if (!take(k, o)) continue;
        for (int a = 0; a < f.histories; ++a) f.history[a][contact] = whole.history[a][contacts_before(whole, o)];
        ++contact;
    }
    for (std::int32_t k = 0; k < rows; ++k) take(ghosts + k, d.row_begin + k);
    const std::int32_t from = contacts_before(whole, d.row_begin), to = contacts_before(whole, d.row_end);
    for (int a = 0; a < f.histories; ++a)
        std::copy(whole.history[a] + from, whole.history[a] + to, f.history[a] + contact);
    for (std::int32_t k = ghosts + rows; k < ghosts + rows + spare; ++k) {
        f.outer_first[k] = place_at(d.filler);
        f.outer_second[k] = place_at(d.filler + 1);
        f.outer_reach[k] = 0;
    }
}

/// The part of the whole inner list that is in a subdomain.
void Subdomains::fill_inner(Subdomain& d, const Field& whole) const {
    const std::int32_t width = kernels_->width, all = true_pairs(whole);
    const auto ghosts = static_cast<std::int32_t>(d.ghost.size());
    Field f = d.view(whole);
    std::int32_t n = 0;
    const auto take = [&](std::int32_t from, std::int32_t source) {
        f.inner_first[n] = f.outer_first[source];
        f.inner_second[n] = f.outer_second[source];
        f.inner_reach[n] = whole.inner_reach[from];
        f.inner_source[n] = source;
        if (n % width == 0) f.touching[n / width] = 0;
        if (bit_at(whole.touching, from, width)) set_bit(f.touching, n, width);
        ++n;
    };
    const std::span source(whole.inner_source, static_cast<std::size_t>(all));
    for (std::int32_t k = 0; k < ghosts; ++k) {
        const auto at = std::ranges::lower_bound(source, d.ghost[static_cast<std::size_t>(k)]);
        if (at != source.end() && *at == d.ghost[static_cast<std::size_t>(k)])
            take(static_cast<std::int32_t>(at - source.begin()), k);
    }
    const auto end = static_cast<std::int32_t>(std::ranges::lower_bound(source, d.row_end) - source.begin());
    for (auto k = static_cast<std::int32_t>(std::ranges::lower_bound(source, d.row_begin) - source.begin()); k < end;
         ++k)
        take(k, ghosts + whole.inner_source[k] - d.row_begin);
    f.inner_count = fill_up(f, n, width);
    d.count_inner(f);
}

}  // namespace grainsweep::dem::fast
