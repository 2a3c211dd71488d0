// One case on several cores, with the same bits as on one core.
//
// The sorted particles are divided into contiguous ranges, one per thread: subdomains. Each subdomain has its own lists
// with all pairs of its particles. Pairs whose first particle lies in an earlier subdomain come first, in the order of
// the whole list; then the rows of its own particles follow. So the forces on its particles are added in the order of
// the whole list. A pair across subdomains is computed in both, with a copy of its history in each. Both results have
// the same bits, because a lane's result depends on its pair alone. Partners in other subdomains are read from copies
// of their records; forces on copies are not used. Results therefore depend neither on the cuts nor on the number of
// threads. At a rebuild, subdomains whose threads ended late may become smaller.
//
// The changes of a step are sent to the copies. After a subdomain has advanced its particles, it writes the kinematics
// of particles with partners elsewhere into rows. The other subdomains update their copies from these rows before the
// next sweep. So a sweep rarely writes a record that another subdomain has read; writing such a cache line needs a
// message between cores. A step needs only one synchronisation. The rows are prefetched for writing during the sweep
// before. If the rows belong to another state or to other particles, all records are copied before any subdomain
// continues.
//
// Code outside a step (contacts in SI, checkpoints, energy, faults, rebuilds) reads the whole lists; join() writes the
// contacts back to them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/threads.hpp"
#include "solver/threads/shares.hpp"
#include "solver/threads/thread_pool.hpp"

namespace grainsweep::dem::fast {

/// Request to make the inner lists anew before a sweep.
struct Refresh {
    float skin;
    bool marked;  ///< see refresh() in rebuild.hpp
};

/// Members of a record that a step changes and pairs read.
struct Kinematics {
    std::int32_t position[3];
    float velocity[3], spin[3];
};

/// Range of particles and its lists. Places below the number of particles are particles. Behind them, each subdomain
/// has two records that pad vectors, and the copies of its partners in other subdomains.
struct alignas(64) Subdomain {
    std::int32_t begin = 0, end = 0;
    std::int32_t filler = 0;
    std::vector<std::int32_t> partner;   ///< partners in other subdomains, ascending; their copies lie behind the
                                         ///< fillers
    std::vector<std::int32_t> met;       ///< partners in the inner list, as indices in `partner`; only these are
                                         ///< updated in a step
    std::vector<std::int32_t> met_here;  ///< the particles of these copies, ascending
    std::vector<std::uint8_t> is_met;
    std::vector<std::int32_t> sending;     ///< particles with partners in other subdomains: those for the first
                                           ///< subdomain, for the second, ...
    std::vector<std::int32_t> sending_to;  ///< start of each subdomain's part, and the end
    Column<Kinematics> sent[2];  ///< kinematics of `sending`; alternately one is written for the next step while the
                                 ///< other is read
    std::vector<std::int32_t> ghost;          ///< first entries of its outer list: their index in the whole list
    std::vector<std::int32_t> leaving;        ///< pairs of its rows with a later subdomain: their index in the whole
                                              ///< list
    std::int32_t row_begin = 0, row_end = 0;  ///< its rows in the whole outer list
    double ghost_cost = 0;                    ///< cost of a sweep over the ghosts, see choose_ranges()
    std::int32_t inner_count = 0;             ///< a multiple of the width
    std::int32_t inner_ghosts = 0;            ///< pairs at the start of the inner list
    std::int32_t inner_rows = 0;              ///< pairs of its own rows, behind the ghosts
    std::int32_t fetch_ahead = 0;             ///< see Field
    PairColumns pairs;
    Tally tally{};

    /// Returns the whole field with the lists of this subdomain.
    [[nodiscard]] Field view(const Field& whole) const;
    /// Returns the particle at a place; for a copy, the partner.
    [[nodiscard]] std::int32_t particle_at(Place place) const;
    /// Returns the place of a particle in this subdomain.
    [[nodiscard]] Place place_of(std::int32_t particle) const;
    /// Counts the pairs of a new inner list.
    void count_inner(const Field& view);
    /// Returns the number of touching pairs in a part of its inner list.
    [[nodiscard]] std::int32_t touching_in(std::int32_t from, std::int32_t count, std::int32_t width) const;
    /// Copies the records and mobilities of its partners: all, or those in the inner list. `mobility` may be null.
    void copy_partners(Record* records, Mobility* mobility, bool all) const;
    /// Returns its own ones among some particles, ascending.
    [[nodiscard]] std::span<const std::int32_t> own(const std::vector<std::int32_t>& particles) const;
    /// Makes a sweep prefetch the rows that send() will write.
    void fetch_what_is_sent(Field& view, int turn) const;
    /// Writes the kinematics of its particles for the other subdomains.
    void send(const Record* records, int turn) const;
};

class Subdomains {
public:
    Subdomains(const Kernels& kernels, Threads threads) : kernels_(&kernels) { use(threads); }

    /// Sets the threads from the next cut on.
    void use(Threads threads);
    /// Returns the wanted number of subdomains.
    [[nodiscard]] int wanted(std::int32_t particles) const;
    /// Returns the number of subdomains; 1: the whole lists are used.
    [[nodiscard]] int count() const { return subdomains_.empty() ? 1 : static_cast<int>(subdomains_.size()); }
    [[nodiscard]] bool cut() const { return !subdomains_.empty(); }

    /// Divides the whole lists into the wanted number of subdomains. `listed`: also the inner list; otherwise a refresh
    /// follows, and columns.outer_touching marks the touching pairs.
    void cut_up(Field& whole, Columns& columns, bool listed);
    /// Marks in columns.outer_touching the touching pairs of the whole inner list.
    void mark_touching(const Field& whole, Columns& columns) const;
    /// Returns whether new cuts would soon pay for themselves: since the last cut, threads have waited for slower
    /// threads for longer than a cut takes.
    [[nodiscard]] bool uneven() const;
    /// Removes the subdomains, so that the whole lists are used; call join() before.
    void drop() { subdomains_.clear(); }
    /// Returns parts for work other than sweeps, valid while the lists of the subdomains are not needed: from join() to
    /// the next cut.
    [[nodiscard]] Parts parts() const;
    /// Returns a record on which the forces of a part have no effect.
    [[nodiscard]] std::int32_t filler(int part) const { return subdomains_[static_cast<std::size_t>(part)]->filler; }
    /// Writes inner list, touching pairs and histories of all subdomains to the whole lists, unless already done.
    void join(const Field& whole, const Columns& columns) const;

    /// Does the same as the kernel `sweep` for all particles. `keep`: histories do not change. `goes_on`: the previous
    /// sweep advanced the particles, and nothing has changed them since.
    void sweep(Field& whole, std::optional<Refresh> refresh, bool goes_on, bool advance, bool keep, Tally& tally);
    /// Does the same as the kernel `advance`.
    void advance(const Field& whole, Tally& tally);

private:
    void choose_ranges(const Field& whole, const Columns& columns);
    void set_ranges(const Field& whole, const Columns& columns);
    void find_crossing_pairs(const Field& whole);
    void find_partners(const Field& whole);
    void place_copies(Field& whole, Columns& columns);
    void fill(Subdomain& subdomain, const Field& whole) const;
    void fill_inner(Subdomain& subdomain, const Field& whole) const;
    [[nodiscard]] std::int32_t contacts_before(const Field& whole, std::int32_t pair) const;
    void find_what_to_send(int part) const;
    void receive(const Field& whole, int part) const;
    void join_part(const Field& whole, int part, std::int32_t pairs, std::int32_t contacts) const;
    void merge(Tally& tally) const;

    const Kernels* kernels_;
    Threads threads_{};
    std::unique_ptr<ThreadPool> pool_;
    Shares shares_;  ///< of the subdomains
    std::vector<std::unique_ptr<Subdomain>> subdomains_;
    int turn_ = 0;                               ///< index of Subdomain::sent that the next sweep reads
    std::vector<std::int32_t> contacts_before_;  ///< contacts before each vector of the whole outer list
    double cut_seconds_ = 0;                     ///< duration of the last cut
    mutable bool joined_ = true;
};

}  // namespace grainsweep::dem::fast
