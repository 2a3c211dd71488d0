// One case on several cores, with the bits of one.
//
// The sorted particles are cut into contiguous ranges, one per thread: subdomains. Each has lists of its own, with all
// pairs that touch one of its particles: first those whose first particle lies in an earlier subdomain, in the order of
// the whole list, then the rows of its own particles. So every force on its particles is added up in the order of the
// whole list. A pair across subdomains is computed in both, with a copy of its history in each, and to the same bits:
// what a lane computes depends on its pair alone. Partners in other subdomains are read from copies of their records;
// what is added to the copies' forces is not used. Hence no bit of a result depends on where the cuts are, and none on
// the number of threads: subdomains whose threads end late may get less, whenever lists are made anew.
//
// What a step changes of the copies is sent: a subdomain that has advanced its particles writes what others meet of
// them into rows, one particle behind another, from which the others bring their copies up to date before the next
// sweep. So mostly a sweep writes no record that another subdomain has read (to write such a line costs a message), and
// a step in all subdomains begins once and ends once. The rows, which were read, are fetched to be written during the
// sweep before. Where they hold another state, or other particles than are needed, records are copied before any
// subdomain goes on.
//
// What is not part of a step (contacts in SI, checkpoints, energy, faults, rebuilding) reads the whole lists: join()
// writes the contacts back to them.
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

/// The lists' inner parts are to be made anew before a sweep.
struct Refresh {
    float skin;
    bool marked;  ///< see refresh() in rebuild.hpp
};

/// What a step changes of a record that pairs read.
struct Kinematics {
    std::int32_t position[3];
    float velocity[3], spin[3];
};

/// One range of particles and its lists. Places below the number of particles are those of the particles; behind come,
/// for each subdomain, two records that fill vectors up, and the copies of its partners in other subdomains.
struct alignas(64) Subdomain {
    std::int32_t begin = 0, end = 0;
    std::int32_t filler = 0;
    std::vector<std::int32_t> partner;   ///< in other subdomains, ascending; their copies lie behind the fillers
    std::vector<std::int32_t> met;       ///< those of the inner list: numbers in `partner`; only they matter each step
    std::vector<std::int32_t> met_here;  ///< the particles that these are copies of, ascending
    std::vector<std::uint8_t> is_met;
    std::vector<std::int32_t> sending;     ///< particles that others meet: for the first subdomain, for the second ...
    std::vector<std::int32_t> sending_to;  ///< where those for each subdomain begin, and where the last end
    Column<Kinematics> sent[2];  ///< of `sending`, in turn: one is written for the next step while the other is read
    std::vector<std::int32_t> ghost;          ///< of its outer list the first ones: where they stand in the whole list
    std::vector<std::int32_t> leaving;        ///< pairs of its rows with a later subdomain, likewise
    std::int32_t row_begin = 0, row_end = 0;  ///< its rows in the whole outer list
    double ghost_cost = 0;                    ///< of a sweep over the ghosts, see choose_ranges()
    std::int32_t inner_count = 0;             ///< a multiple of the width
    std::int32_t inner_ghosts = 0;            ///< the first ones of the inner list
    std::int32_t inner_rows = 0;              ///< those of its own rows, behind them
    std::int32_t fetch_ahead = 0;             ///< see Field
    PairColumns pairs;
    Tally tally{};

    /// The whole field with the lists of this subdomain.
    [[nodiscard]] Field view(const Field& whole) const;
    /// The particle at a place: the partner where it is a copy.
    [[nodiscard]] std::int32_t particle_at(Place place) const;
    /// The place of a particle here.
    [[nodiscard]] Place place_of(std::int32_t particle) const;
    /// After the inner list was made.
    void count_inner(const Field& view);
    /// How many pairs of a part of its inner list touch.
    [[nodiscard]] std::int32_t touching_in(std::int32_t from, std::int32_t count, std::int32_t width) const;
    /// Copies the records of its partners: all, or those that a sweep over the inner list meets.
    void copy_partners(Record* records, std::uint8_t* kind, bool all) const;
    /// Those of some particles, ascending, that are its own.
    [[nodiscard]] std::span<const std::int32_t> own(const std::vector<std::int32_t>& particles) const;
    /// Lets a sweep fetch the rows that send() will write.
    void fetch_what_is_sent(Field& view, int turn) const;
    /// Writes what others meet of its particles, for them to receive.
    void send(const Record* records, int turn) const;
};

class Subdomains {
public:
    Subdomains(const Kernels& kernels, Threads threads) : kernels_(&kernels) { use(threads); }

    /// From the next cut on.
    void use(Threads threads);
    /// How many there should be.
    [[nodiscard]] int wanted(std::int32_t particles) const;
    /// How many there are; 1: the whole lists are used.
    [[nodiscard]] int count() const { return subdomains_.empty() ? 1 : static_cast<int>(subdomains_.size()); }
    [[nodiscard]] bool cut() const { return !subdomains_.empty(); }

    /// Cuts the whole lists into as many parts as wanted. `listed`: the inner list, too; otherwise a refresh follows,
    /// and columns.outer_touching says which pairs touch.
    void cut_up(Field& whole, Columns& columns, bool listed);
    /// Writes to columns.outer_touching which pairs of the whole inner list touch.
    void mark_touching(const Field& whole, Columns& columns) const;
    /// Whether other cuts would soon save what it costs to make them: since the last cut, threads have waited for
    /// longer than that for those that ended later.
    [[nodiscard]] bool uneven() const;
    /// The whole lists are used from here on; they must have been joined.
    void drop() { subdomains_.clear(); }
    /// For what is no sweep, while the lists of the subdomains are not needed: after they were joined, until they are
    /// cut anew.
    [[nodiscard]] Parts parts() const;
    /// A record that a part may add forces to in vain.
    [[nodiscard]] std::int32_t filler(int part) const { return subdomains_[static_cast<std::size_t>(part)]->filler; }
    /// Writes inner list, touching pairs and histories of all subdomains to the whole lists, where they are not yet.
    void join(const Field& whole, const Columns& columns) const;

    /// As the kernel of that name over all particles. `keep`: the histories remain those of before. `goes_on`: the
    /// sweep before advanced the particles, and nothing else has changed them since.
    void sweep(Field& whole, std::optional<Refresh> refresh, bool goes_on, bool advance, bool keep, Tally& tally);
    /// As the kernel of that name.
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
    int turn_ = 0;                               ///< of Subdomain::sent, that which the next sweep reads
    std::vector<std::int32_t> contacts_before_;  ///< vectors of the whole outer list
    double cut_seconds_ = 0;                     ///< that the last cut took
    mutable bool joined_ = true;
};

}  // namespace grainsweep::dem::fast
