#include "solver/dem/fast/subdomains.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <thread>

#include "solver/dem/fast/rebuild.hpp"

namespace grainsweep::dem::fast {

namespace {

// What a sweep costs, relative to one another: a particle that is advanced, a contact, a pair that is only listed.
// Of a pair of another subdomain's rows also its particles, which come out of order and are waited for.
constexpr double cost_of_particle = 4, cost_of_contact = 5, cost_of_pair = 0.3, cost_of_waiting = 1.5;

std::int32_t index_at(Place place) {
    return static_cast<std::int32_t>(place / places_per_index);
}
Place place_at(std::int32_t index) {
    return static_cast<Place>(index * places_per_index);
}

bool bit_at(const std::uint16_t* bits, std::int32_t k, std::int32_t width) {
    return (static_cast<unsigned>(bits[k / width]) >> static_cast<unsigned>(k % width) & 1U) != 0;
}
void set_bit(std::uint16_t* bits, std::int32_t k, std::int32_t width) {
    bits[k / width] = static_cast<std::uint16_t>(bits[k / width] | 1U << static_cast<unsigned>(k % width));
}

/// Pairs of a sorted list whose first particle comes before this one.
std::int32_t pairs_before(const Place* first, std::int32_t count, std::int32_t particle) {
    return static_cast<std::int32_t>(std::lower_bound(first, first + count, place_at(particle)) - first);
}

/// Inner pairs without those that fill the last vector up.
std::int32_t true_pairs(const Field& f) {
    std::int32_t k = f.inner_count;
    while (k > 0 && f.inner_first[k - 1] == place_at(f.filler)) --k;
    return k;
}

/// Ends an inner list as the refresh kernel does.
std::int32_t fill_up(const Field& f, std::int32_t count, std::int32_t width) {
    const std::int32_t padded = (count + width - 1) / width * width;
    for (std::int32_t k = count; k < padded + 2 * tile; ++k) {
        f.inner_first[k] = place_at(f.filler);
        f.inner_second[k] = place_at(f.filler + 1);
        f.inner_reach[k] = 0;
        f.inner_source[k] = 0;
    }
    return padded;
}

/// Met nothing yet.
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
    for (std::int32_t k = inner_ghosts; k < all; ++k) look_at(view.inner_second[k]);
    met.clear();
    for (std::size_t k = 0; k < is_met.size(); ++k)
        if (is_met[k] != 0) met.push_back(static_cast<std::int32_t>(k));
}

void Subdomain::copy_partners(Record* records, bool all) const {
    Record* const copy = records + filler + 2;
    if (all)
        for (std::size_t k = 0; k < partner.size(); ++k) copy[k] = records[partner[k]];
    else
        for (const std::int32_t k : met) copy[k] = records[partner[static_cast<std::size_t>(k)]];
}

void Subdomains::use(Threads threads) {
    threads_ = threads;
    if (threads_.most <= 0) threads_.most = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    threads_.least_particles = std::max(1, threads_.least_particles);
}

int Subdomains::wanted(std::int32_t particles) const {
    return std::clamp(static_cast<int>(particles / threads_.least_particles), 1, threads_.most);
}

std::int32_t Subdomains::contacts_before(const Field& whole, std::int32_t pair) const {
    const std::int32_t width = kernels_->width, rest = pair % width;
    const auto vector = static_cast<std::size_t>(pair / width);
    const unsigned before = rest == 0 ? 0 : whole.outer_touching[vector] & ((1U << static_cast<unsigned>(rest)) - 1);
    return contacts_before_[vector] + std::popcount(before);
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
    if (pool_ == nullptr || pool_->size() != parts) pool_ = std::make_unique<ThreadPool>(parts);
    const std::int32_t width = kernels_->width;
    const std::int32_t vectors = whole.outer_count / width + 1;
    if (listed) {
        columns.outer_touching.clear(static_cast<std::size_t>(vectors) + 1);
        for (std::int32_t k = 0; k < whole.inner_count; ++k)
            if (bit_at(whole.touching, k, width)) set_bit(whole.outer_touching, whole.inner_source[k], width);
    }
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
        d->pairs.hold_pairs(d->ghost.size() + static_cast<std::size_t>(d->row_end - d->row_begin) + 2 * tile);
    }
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        fill(d, whole);
        if (listed) fill_inner(d, whole);
    });
    joined_ = true;
}

/// Ranges that cost about the same. Pairs across subdomains are computed in both: what a subdomain computes of the
/// earlier ones' depends little on where exactly its range begins, and is known from ranges chosen without it.
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

/// Ranges of equal cost with the ghosts' costs as they are.
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
        share += total / parts - d.ghost_cost;
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
    std::size_t next = even(static_cast<std::size_t>(whole.count) + 4);
    for (const auto& subdomain : subdomains_) {
        subdomain->filler = static_cast<std::int32_t>(next);
        next = even(next + 2 + subdomain->partner.size());
    }
    columns.records.hold(next + spare);
    columns.forces.hold(next + spare);
    columns.bind(whole);
    for (const auto& subdomain : subdomains_)
        for (std::int32_t k = 0; k < 2; ++k) whole.records[subdomain->filler + k] = whole.records[whole.filler + k];
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

void Subdomains::join(const Field& whole, const Columns& columns) const {
    if (subdomains_.empty() || joined_) return;
    const std::int32_t width = kernels_->width;
    std::fill_n(whole.touching, columns.touching.capacity(), std::uint16_t{0});
    std::int32_t n = 0, contacts = 0;
    for (const auto& subdomain : subdomains_) {
        const Subdomain& d = *subdomain;
        const Field f = d.view(whole);
        const auto ghosts = static_cast<std::int32_t>(d.ghost.size());
        std::int32_t ghost_contacts = 0, row_contacts = 0;
        for (std::int32_t k = 0; k < d.inner_ghosts; ++k) ghost_contacts += bit_at(f.touching, k, width) ? 1 : 0;
        for (std::int32_t k = d.inner_ghosts; k < d.inner_ghosts + d.inner_rows; ++k, ++n) {
            whole.inner_first[n] = f.inner_first[k];
            whole.inner_second[n] = place_at(d.particle_at(f.inner_second[k]));
            whole.inner_reach[n] = f.inner_reach[k];
            whole.inner_source[n] = d.row_begin + f.inner_source[k] - ghosts;
            if (!bit_at(f.touching, k, width)) continue;
            set_bit(whole.touching, n, width);
            ++row_contacts;
        }
        for (int a = 0; a < f.histories; ++a)
            std::copy_n(f.history[a] + ghost_contacts, row_contacts, whole.history[a] + contacts);
        contacts += row_contacts;
    }
    fill_up(whole, n, width);
    joined_ = true;
}

void Subdomains::sweep(Field& whole, std::optional<Refresh> renewal, bool advance, bool keep, Tally& tally) {
    pool_->run([&](int part) {
        subdomains_[static_cast<std::size_t>(part)]->copy_partners(whole.records, renewal.has_value());
    });
    pool_->run([&](int part) {
        Subdomain& d = *subdomains_[static_cast<std::size_t>(part)];
        Field f = d.view(whole);
        if (renewal) {
            refresh(f, d.pairs, *kernels_, renewal->skin, renewal->marked);
            d.count_inner(f);
        }
        d.tally = neutral_tally();
        kernels_->sweep(f, advance, d.tally);
        if (!keep) d.pairs.swap_histories(f);
    });
    if (renewal) {
        std::int32_t pairs = 0;
        for (const auto& subdomain : subdomains_) pairs += subdomain->inner_rows;
        whole.inner_count = (pairs + kernels_->width - 1) / kernels_->width * kernels_->width;
    }
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
