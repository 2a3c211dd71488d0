// What the mixed-precision engine keeps in memory, and the constants of a case in its own units.
//
// Units inside: length is the largest particle diameter, time the time step, mass the mass of the largest
// particle. A velocity is then the displacement per step, a force divided by a mass the change of velocity per
// step, and every number a contact meets lies far from the ends of single precision.
//
// Positions are 32-bit integers per axis, counted from the middle of the domain. On a periodic axis 2^32 units are
// exactly one period, so the difference of two positions is the nearest image without a branch. On an open axis the
// domain fills less than half the range. Differences are exact; only the law's arithmetic rounds.
//
// This header holds data only: it is included by files compiled for different instruction sets, and an inline
// function compiled for one of them must never be what the linker keeps for all.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/dem/laws/compiled.hpp"

namespace grainsweep::dem::fast {

/// Touching pairs worked on at a time: the fewest with which beds and chutes were fastest (docs/tried_and_dropped.md).
/// No bit depends on it.
constexpr std::int32_t tile = 256;
/// Contacts with a wall worked on at a time. Its sums are formed row by row: another number rounds them otherwise.
constexpr std::int32_t wall_tile = 128;
/// Vectors of listed particles that fill such a tile, at most.
constexpr std::int32_t listed_vectors = 64;
/// Spare entries of every column: lists are filled up, and read ahead, by as much as a tile and twice the widest
/// vector.
constexpr std::int32_t spare = 2 * tile + 64;

/// A particle in a list: its index times eight, so that its record and its force are one scaled address away.
using Place = std::uint32_t;
constexpr std::int32_t places_per_index = 8;

/// Bytes that a core takes from another one's caches at a time.
constexpr std::int32_t cache_line = 64;

/// Records behind those of the particles, which fill vectors up.
constexpr std::int32_t fillers = 3;

/// One particle as the pair loop reads it: one cache line.
struct alignas(64) Record {
    std::int32_t position[3];
    float inverse_radius;
    float velocity[3];   ///< at the half step
    float inverse_mass;  ///< 0: frozen, or any wall
    float spin[3];       ///< angular velocity at the half step
    float radius;        ///< 0: any wall
    /// Where radii differ: radius times spin, and the radius again. Where they are equal: of Residual the position, and
    /// the first component of the velocity.
    float rest[4];
};

/// What the last additions to position and velocity could not represent; carried to the next step. A column of its own
/// where radii differ, otherwise in Record and Force (left_over.hpp).
struct alignas(32) Residual {
    float position[4];
    float velocity[4];
};

/// Sum of forces, and of torques, on one particle. Where radii are equal the fourth numbers are the second and third
/// component of the velocity of Residual: whatever is added to forces leaves them as they are.
struct alignas(32) Force {
    float force[4];
    float torque[4];
};

/// Numbers of a contact history.
constexpr std::int32_t histories_at_most = memories_at_most;

/// A contact of two particles neither of which is advanced, with its force while both stand still.
struct ParkedContact {
    std::int32_t first, second;  ///< indices of the records
    float history[histories_at_most];
    float force[3];      ///< on the first
    float torque[2][3];  ///< on the first, on the second
    float overlap;       ///< over the smaller diameter
};

/// Constants of a case, in the engine's units.
struct Constants {
    double unit[3];  ///< length of one position unit
    float unit_single[3];
    float inverse_unit[4];           ///< fourth: 0
    float gravity[8];                ///< change of velocity per step; spin part 0
    float radius;                    ///< of all particles where they are equal
    double reach_squared;            ///< (2 radius)^2, exact
    float candidate_squared;         ///< the same, enlarged by the rounding of single precision
    float beyond, beyond_wall;       ///< how far contacts may last beyond touch, of pairs and at walls
    float root_radius;               ///< sqrt(R*) of an equal pair
    float rotation;                  ///< 2.5/R^2 where radii are equal
    double laws[constants_at_most];  ///< of the combination of laws, in order; of the first pair of kinds
};

/// Bytes of what a shape is written in for lanes, at most.
constexpr std::size_t numbers_at_most = 128;

/// A wall at the present time, in the engine's units, relative to the middle of the domain.
struct alignas(16) PlacedWall {
    std::int32_t shape;                              ///< its number in the list of shapes
    std::int32_t imaged;                             ///< 1: it has periodic images
    std::int32_t turned;                             ///< 1: its numbers are those of its body frame
    std::int32_t turns;                              ///< 1: its material turns
    std::int32_t summed;                             ///< 1: its sums are asked for, otherwise it is at rest
    double origin[3];                                ///< what the following, and the numbers, are relative to
    double middle[3], period[3], inverse_period[3];  ///< of images; 0 along axes that have none
    double rows[3][3];                               ///< of the turn from its body frame
    double velocity[3], spin[3], pivot[3];           ///< of its material
    double laws[constants_at_most];                  ///< of its surface, in contacts with the first kind
    const double* laws_of_kinds;                     ///< rows of constants_at_most, where there are several kinds
    unsigned char numbers[numbers_at_most];
};

/// Overlap, in largest diameters, that says: this piece may be touched on one of its sides.
constexpr float undecided = -1;

/// Which pieces of a wall's shape particles may touch now, and where the touched ones are to be written.
struct PieceList {
    const double* numbers;  ///< of each piece, `stride` of them
    std::int32_t stride;
    double margin;               ///< a foot on the plane counts as inside a piece if it is so by more than this
    std::int32_t near;           ///< particles
    const Place* particle;       ///< of each
    const std::int32_t* first;   ///< where its candidates begin
    const std::int32_t* active;  ///< how many of them count now
    const std::uint32_t* candidate;
    std::int32_t* entry;   ///< out: number in `particle`
    std::uint32_t* piece;  ///< out
};

/// Load of the particles on a wall in one step: the sum of their forces (to be reversed), of the torques about the
/// pivot, and of force times velocity of the wall's material.
struct WallSums {
    double force[3], torque[3], power;
};

/// Contacts of one wall: a segment of the wall arrays, padded to the vector width.
struct WallSegment {
    std::int32_t begin, end;
};

/// Largest and smallest velocities met by a sweep, and its largest overlap; what the next step's safety rests on.
struct alignas(32) Tally {
    float velocity_high[8];
    float velocity_low[8];
    float overlap;           ///< of pairs, over the smaller diameter
    float wall_overlap;      ///< over the diameter
    std::int64_t unused[3];  ///< fills a saved tally up; 0
};

/// Raw view of everything a kernel touches. Owners live in files compiled for the baseline.
struct Field {
    Constants constants;
    /// Particles present. Behind them in `records`: two far apart ones that fill vectors of pairs up, and one that
    /// fills vectors of wall contacts up.
    std::int32_t count;
    /// Particles whose pairs the lists hold, and which a sweep advances: all, or those of a subdomain (subdomains.hpp).
    std::int32_t begin, end;
    std::int32_t filler;  ///< index of the two records that fill vectors of pairs up

    std::int32_t read_ahead;  ///< 1: the particles do not fit the caches near the core, fetch them early
    std::int32_t streams;     ///< 1: nor the caches far from it, new histories are written past all of them
    /// Most particles meet partners up to nearly as many places behind them: so far ahead of the particle that is
    /// integrated, records and forces are fetched. 0: nothing is. Changes no bit.
    std::int32_t fetch_ahead;

    /// What is written behind a sweep and was read on another core: its cache lines are fetched to be written during
    /// the sweep, so that nothing waits for them after it. Changes no bit.
    const std::byte* written_after;
    std::int32_t lines_written_after;

    Record* records;
    Residual* residuals;  ///< null where radii are equal
    Force* forces;
    /// Particles that are advanced, in order, and how many of them come before each; on the others, frozen or at
    /// rest, forces add up. Null, and never read, where none are passed over: what is frozen then takes no step.
    const std::int32_t* advanced;
    const std::int32_t* advanced_before;  ///< count+1
    std::int32_t skips;                   ///< 1: they are read

    // Kinds of particles; read where there are several.
    std::uint8_t* kind;           ///< of each record
    std::int32_t kinds;           ///< how many
    const double* laws_of_pairs;  ///< rows of constants_at_most: of kind a with kind b in row a*kinds + b

    // Inner list: pairs that may touch before the next refresh, sorted by the first particle.
    Place* inner_first;
    Place* inner_second;
    float* inner_reach;          ///< candidate distance squared, where radii differ
    std::int32_t* inner_source;  ///< index in the outer list
    std::int32_t inner_count;    ///< a multiple of the width
    // Bit k of mask b: pair b*width+k touched at the last step; histories of those, in that order, without gaps.
    std::uint16_t* touching;
    std::uint16_t* touching_next;
    std::int32_t histories;  ///< columns in use
    float* history[histories_at_most];
    float* history_next[histories_at_most];
    float history_step;  ///< 1: the step displaces the tangential springs, 0: forces only

    // Outer list, sorted by the first particle.
    Place* outer_first;
    Place* outer_second;
    float* outer_reach;  ///< sum of radii, where they differ
    std::uint16_t* outer_touching;
    std::int32_t outer_count;
    std::int32_t* row;  ///< where each first particle begins in the outer list; count+1

    // Search: columns of the sorted particles, and cells.
    std::int32_t* column[3];
    float* column_radius;
    float* column_mobile;  ///< 1 mobile, 0 frozen
    std::int32_t* cell_start;
    std::int32_t cells[3];              ///< along fast, middle and slow axis
    std::int32_t wraps[3];              ///< 1: periodic
    std::int32_t cell_begin, cell_end;  ///< those whose particles' pairs a search looks for
    std::int32_t outer_capacity;

    // Walls.
    std::int32_t wall_filler;  ///< index of a record that fills vectors of wall contacts up
    const PlacedWall* walls;
    WallSums* wall_sums;
    WallSegment* segments;
    std::int32_t wall_count;
    Place* wall_particle;
    float* wall_history[histories_at_most];
    // Contacts with walls of shapes that may be touched in several places, found before the kernel: a segment each.
    WallSegment* touched;
    Place* touch_particle;
    float* touch_overlap;
    float* touch_normal[3];
    float* touch_velocity[3];  ///< of the wall's material
    float* touch_lever[3];     ///< from the wall's pivot
    float* touch_memory[histories_at_most];
};

/// The operations compiled once per instruction path.
struct Kernels {
    std::int32_t width;
    /// Forces of all listed pairs, added to what forces holds; with `advance` every particle is integrated as
    /// soon as its force is complete. Writes touching_next and history_next.
    void (*sweep)(const Field&, bool advance, Tally&);
    /// Integrates all particles with the forces that are there, and clears these.
    void (*advance)(const Field&, Tally&);
    /// Forces of a wall on the listed particles from number `begin` to `end`, in tiles; what they sum up to is added.
    void (*walls)(const Field&, std::int32_t wall, WallSegment, Tally&, WallSums&);
    /// Which lanes of these vectors of a wall's list touch it; walls touched in one place only.
    void (*touching)(const Field&, std::int32_t wall, WallSegment, std::uint16_t* lanes);
    /// Pieces of a wall that particles touch, into the columns of touches from `at` on, in the order of the list.
    /// Returns their number.
    std::int32_t (*pieces)(const Field&, std::int32_t wall, const PieceList&, std::int32_t at);
    /// Outer list of pairs closer than `skin` beyond contact, of the first particles in a range of cells, and their
    /// rows. Returns the count needed; more than outer_capacity: nothing beyond was written.
    std::int64_t (*search)(const Field&, float skin);
    /// Inner list from the outer one: gap below `skin`, or touching. Returns the padded count.
    std::int32_t (*refresh)(const Field&, float skin);
};

/// What a case needs; decides which compiled sweep runs.
struct Needs {
    std::int32_t combination;  ///< of laws, its number in the list
    bool unequal;              ///< radii differ, or the combination is compiled for such only
    bool frozen;               ///< particles of infinite mass are present
    bool resting;              ///< particles at rest may be left unadvanced
    bool several;              ///< kinds of particles, with constants of their own
    bool skips;                ///< those that are not advanced are passed over: worth its list unless they are few
    /// Whether some particles are not advanced, or the kernel allows for it.
    [[nodiscard]] constexpr bool holds() const { return unequal || frozen || resting || several; }
};

[[nodiscard]] const Kernels& baseline_kernels(const Needs&);
[[nodiscard]] const Kernels& avx2_kernels(const Needs&);
[[nodiscard]] const Kernels& avx512_kernels(const Needs&);

}  // namespace grainsweep::dem::fast
