// Memory layout of the mixed-precision engine, and the constants of a case in its units.
//
// Units: the length is the largest particle diameter, the time is the time step, the mass is the mass of the largest
// particle. A velocity is then the displacement per step, and a force divided by a mass the change of velocity per
// step. All numbers of a contact lie far from the limits of single precision.
//
// Positions are 32-bit integers per axis, counted from the middle of the domain. On a periodic axis 2^32 units are
// exactly one period, so the difference of two positions is the nearest image without a branch. On an open axis the
// domain uses less than half the range. Differences are exact; only the arithmetic of the law rounds.
//
// This header contains data only. Files compiled for different instruction sets include it, and the linker could keep
// one of their inline functions for all of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/dem/laws/compiled.hpp"

namespace grainsweep::dem::fast {

/// Touching pairs in a tile: the smallest number with which beds and chutes were fastest (docs/tried_and_dropped.md).
/// No bit depends on it.
constexpr std::int32_t tile = 256;
/// Contacts with a wall in a tile. Sums are formed row by row, so another number would change their rounding.
constexpr std::int32_t wall_tile = 128;
/// Largest number of vectors of listed particles in such a tile.
constexpr std::int32_t listed_vectors = 64;
/// Spare entries of every column: lists are padded, and read ahead, by a tile and twice the widest vector.
constexpr std::int32_t spare = 2 * tile + 64;

/// Particle in a list: its index times eight, so that its record and its force need only one scaled address.
using Place = std::uint32_t;
constexpr std::int32_t places_per_index = 8;

/// Bytes of a cache line, the unit of transfer between cores.
constexpr std::int32_t cache_line = 64;

/// Number of records behind the particles that pad vectors.
constexpr std::int32_t fillers = 3;

/// Particle for the pair loop: one cache line.
struct alignas(64) Record {
    std::int32_t position[3];
    float inverse_radius;
    float velocity[3];   ///< at the half step
    float inverse_mass;  ///< 0: frozen particle, or wall
    float spin[3];       ///< angular velocity at the half step
    float radius;        ///< 0: wall
    /// If radii differ: radius times spin, and the radius again. If they are equal: position of the Residual, and the
    /// first component of its velocity.
    float rest[4];
};

/// Rounding errors of the last additions to position and velocity, carried to the next step. A separate column if radii
/// differ, otherwise stored in Record and Force (residual.hpp).
struct alignas(32) Residual {
    float position[4];  ///< fourth, if radii differ: what single precision drops of the radius; 0 for members of clumps
    float velocity[4];
};

/// Sums of forces and torques on one particle. If radii are equal, the fourth numbers are the second and third velocity
/// components of Residual; additions to forces do not change them.
struct alignas(32) Force {
    float force[4];
    float torque[4];
};

/// Largest number of values of a contact history.
constexpr std::int32_t histories_at_most = memories_at_most;

/// Contact of two particles that are not advanced, with its constant force.
struct ParkedContact {
    std::int32_t first, second;  ///< indices of the records
    float history[histories_at_most];
    float force[3];      ///< on the first
    float torque[2][3];  ///< on the first, on the second
    float overlap;       ///< divided by the smaller diameter
};

/// Matrix M of a particle: a contact with it along n has the inverse mass n M n (clump_lanes.hpp), in the engine's
/// units. Of a sphere 1/m on the diagonal.
struct alignas(32) Mobility {
    float of[8];  ///< xx, xy, xz, yy, yz, zz, 0, 0
};

/// Clumps of as many members each that are stepped together, one per lane.
struct ClumpBatch {
    std::int32_t first;    ///< body
    std::int32_t bodies;   ///< at most the vector width; the lanes behind them repeat the first
    std::int32_t members;  ///< of each
    std::int32_t slot;     ///< start of its places: first members of all lanes, second members, ...
    // Start of its entries in columns by lane, and in those by member and lane. Batches of one shape and size share
    // them.
    std::int32_t lane, row;
};

/// Raw view of all clumps. Vectors of columns by body follow one another; the owner is Clumps.
struct ClumpView {
    const ClumpBatch* batches;
    // By body, SI.
    double *position, *velocity, *momentum, *orientation, *spin_in_step, *fallen;
    // By lane.
    const double *mass, *inverse_mass;  ///< kg, 1/kg
    const double* inverse_inertia[3];   ///< 1/(kg m2)
    const float* turning[3];            ///< the same in the engine's units; 0: contacts are damped by the mass
    const float* inverse_mass_single;   ///< engine's units
    const float* reach;                 ///< largest distance of a member's centre, engine's units
    const Place* place;                 ///< of members
    // By member and lane.
    const double* at[3];        ///< from the centre, in the frame of the body, m
    const float* single_at[3];  ///< the same in the engine's units
    const float *radius, *inverse_radius;

    double length, time, force;            ///< units, SI
    double inverse_length, inverse_speed;  ///< their inverse
    double centre[3], inverse_unit[3];     ///< of positions, m, 1/m
    double gravity[3], acceleration[3];    ///< m/s2; gravity alone, and with shaking
};

/// Constants of a case, in the engine's units.
struct Constants {
    double unit[3];  ///< length of one position unit
    float unit_single[3];
    float inverse_unit[4];           ///< fourth: 0
    float gravity[8];                ///< change of velocity per step; spin part 0
    float radius;                    ///< of all particles, if radii are equal
    double reach_squared;            ///< (2 radius)^2, exact
    float candidate_squared;         ///< reach_squared enlarged by the rounding of single precision
    float beyond, beyond_wall;       ///< largest gap of a lasting contact, of pairs and at walls
    float root_radius;               ///< sqrt(R*) of an equal pair
    float rotation;                  ///< 2.5/R^2, if radii are equal
    double laws[constants_at_most];  ///< constants of the combination of laws, in order, for the first pair of kinds
};

/// Largest number of bytes of a shape in the form for lanes.
constexpr std::size_t numbers_at_most = 128;

/// Wall at the present time, in the engine's units, relative to the middle of the domain.
struct alignas(16) PlacedWall {
    std::int32_t shape;                              ///< its number in the list of shapes
    std::int32_t imaged;                             ///< 1: it has periodic images
    std::int32_t turned;                             ///< 1: its numbers are in its body frame
    std::int32_t turns;                              ///< 1: its material rotates
    std::int32_t conveys;                            ///< 1: its surface moves along itself
    std::int32_t summed;                             ///< 1: its sums are needed; otherwise it is at rest
    double origin[3];                                ///< origin of the following members and of the numbers
    double middle[3], period[3], inverse_period[3];  ///< of images; 0 along axes without images
    double rows[3][3];                               ///< rotation from its body frame
    double velocity[3], spin[3], pivot[3];           ///< of its material
    double surface[3];                               ///< velocity whose part along the surface it has besides
    double laws[constants_at_most];                  ///< of its surface, in contacts with the first kind
    const double* laws_of_kinds;                     ///< rows of constants_at_most, where there are several kinds
    unsigned char numbers[numbers_at_most];
};

/// Special overlap: this piece may be touched on one of its sides.
constexpr float undecided = -1;

/// Pieces of a wall's shape that particles may touch now, and the output for the touched pieces.
struct PieceList {
    const double* numbers;  ///< of each piece, `stride` of them
    std::int32_t stride;
    double margin;               ///< a foot point counts as inside a piece only if its distance from the sides exceeds
                                 ///< this
    std::int32_t near;           ///< particles
    const Place* particle;       ///< of each
    const std::int32_t* first;   ///< start of its candidates
    const std::int32_t* active;  ///< number of its candidates that are tested now
    const std::uint32_t* candidate;
    std::int32_t* entry;   ///< out: number in `particle`
    std::uint32_t* piece;  ///< out
};

/// Load of the particles on a wall in one step: sums of the forces on the particles (opposite sign), of the torques
/// about the pivot, and of force times velocity of the wall's material.
struct WallSums {
    double force[3], torque[3], power;
};

/// Segment of the wall arrays with the contacts of one wall, padded to the vector width.
struct WallSegment {
    std::int32_t begin, end;
};

/// Largest and smallest velocities and largest overlap of a sweep, for the safety checks of the next step.
struct alignas(32) Tally {
    float velocity_high[8];
    float velocity_low[8];
    float overlap;           ///< of pairs, divided by the smaller diameter
    float wall_overlap;      ///< divided by the diameter
    std::int64_t unused[3];  ///< padding of a saved tally; 0
};

/// Raw view of all data that a kernel uses. The owners are in files compiled for the baseline.
struct Field {
    Constants constants;
    /// Number of particles present. Behind them in `records` are two distant records that pad vectors of pairs, and one
    /// that pads vectors of wall contacts.
    std::int32_t count;
    /// Range of particles whose pairs are in the lists and which a sweep advances: all, or a subdomain
    /// (subdomains.hpp).
    std::int32_t begin, end;
    std::int32_t filler;  ///< index of the two records that pad vectors of pairs

    std::int32_t read_ahead;  ///< 1: the particles do not fit the caches near the core and are fetched early
    std::int32_t streams;     ///< 1: the particles do not fit any cache; new histories are written past the caches
    /// Distance in places by which records and forces are fetched ahead of the integrated particle. Most partners of a
    /// particle lie within this distance. 0: no fetching. Changes no bit.
    std::int32_t fetch_ahead;

    /// Memory that is written after the sweep and was read by another core. Its cache lines are fetched during the
    /// sweep, so that writing does not wait for them. Changes no bit.
    const std::byte* written_after;
    std::int32_t lines_written_after;

    Record* records;
    Residual* residuals;  ///< null if radii are equal
    Force* forces;
    /// Advanced particles in order, and for each particle the number of advanced ones before it. Forces on all other
    /// particles (frozen or at rest) add up. Null, and never read, if no particle is skipped; frozen particles then
    /// take no step.
    const std::int32_t* advanced;
    const std::int32_t* advanced_before;  ///< count+1
    std::int32_t skips;                   ///< 1: `advanced` is read

    // Kinds of particles; read only if there are several.
    std::uint8_t* kind;           ///< of each record
    std::int32_t kinds;           ///< number of kinds
    const double* laws_of_pairs;  ///< rows of constants_at_most: of kind a with kind b in row a*kinds + b

    // Clumps; null if there are none.
    std::int32_t* member;             ///< number of each record among the members; -1: it is no member
    const std::int32_t* member_body;  ///< of each member
    Mobility* mobility;               ///< of each record

    // Inner list: pairs that may touch before the next refresh, sorted by the first particle.
    Place* inner_first;
    Place* inner_second;
    float* inner_reach;          ///< squared distance of a candidate, if radii differ
    std::int32_t* inner_source;  ///< index in the outer list
    std::int32_t inner_count;    ///< a multiple of the width
    // Bit k of mask b: pair b*width+k touched at the last step. Histories of these pairs, in this order, without gaps.
    std::uint16_t* touching;
    std::uint16_t* touching_next;
    std::int32_t histories;  ///< columns in use
    float* history[histories_at_most];
    float* history_next[histories_at_most];
    float history_step;  ///< 1: the step displaces the tangential springs; 0: forces only

    // Outer list, sorted by the first particle.
    Place* outer_first;
    Place* outer_second;
    float* outer_reach;  ///< sum of radii, if they differ
    std::uint16_t* outer_touching;
    std::int32_t outer_count;
    std::int32_t* row;  ///< start of each first particle in the outer list; count+1

    // Search: columns of the sorted particles, and cells.
    std::int32_t* column[3];
    float* column_radius;
    float* column_mobile;  ///< 1 mobile, 0 frozen
    std::int32_t* cell_start;
    std::int32_t cells[3];              ///< along fast, middle and slow axis
    std::int32_t wraps[3];              ///< 1: periodic
    std::int32_t cell_begin, cell_end;  ///< cells whose particles' pairs are searched
    std::int32_t outer_capacity;

    // Walls.
    std::int32_t wall_filler;  ///< index of a record that pads vectors of wall contacts
    const PlacedWall* walls;
    WallSums* wall_sums;
    WallSegment* segments;
    std::int32_t wall_count;
    Place* wall_particle;
    float* wall_history[histories_at_most];
    // Contacts with walls that may be touched in several places, found before the kernel: one segment per wall.
    WallSegment* touched;
    Place* touch_particle;
    float* touch_overlap;
    float* touch_normal[3];
    float* touch_velocity[3];  ///< of the wall's material
    float* touch_lever[3];     ///< from the wall's pivot
    float* touch_memory[histories_at_most];
};

/// Operations compiled once per instruction path.
struct Kernels {
    std::int32_t width;
    /// Adds the forces of all listed pairs to `forces`. With `advance`, every particle is integrated as soon as its
    /// force is complete. Writes touching_next and history_next.
    void (*sweep)(const Field&, bool advance, Tally&);
    /// Integrates all particles with the present forces, and clears the forces.
    void (*advance)(const Field&, Tally&);
    /// Adds the forces of a wall on the listed particles from `begin` to `end`, in tiles, and their sums.
    void (*walls)(const Field&, std::int32_t wall, WallSegment, Tally&, WallSums&);
    /// Finds the lanes of a wall's list that touch it; only for walls touched in one place.
    void (*touching)(const Field&, std::int32_t wall, WallSegment, std::uint16_t* lanes);
    /// Writes the pieces of a wall that particles touch to the columns of touches from `at`, in the order of the list.
    /// Returns their number.
    std::int32_t (*pieces)(const Field&, std::int32_t wall, const PieceList&, std::int32_t at);
    /// Makes the outer list of pairs closer than `skin` beyond contact, for the first particles in a range of cells,
    /// and their rows. Returns the number of pairs; pairs beyond outer_capacity are not written.
    std::int64_t (*search)(const Field&, float skin);
    /// Makes the inner list from the outer list: pairs with a gap below `skin`, or touching. Returns the padded count.
    std::int32_t (*refresh)(const Field&, float skin);
    /// Steps the clumps of some batches by the forces on their members, which it clears, and writes the members.
    void (*step_clumps)(const Field&, const ClumpView&, std::int32_t begin, std::int32_t end, Tally&);
    /// Writes the mobilities of the members of some batches.
    void (*find_mobility)(const Field&, const ClumpView&, std::int32_t begin, std::int32_t end);
};

/// Needs of a case, which select the compiled sweep.
struct Needs {
    std::int32_t combination;  ///< number of the combination of laws in the list
    bool unequal;              ///< radii differ, or the combination is compiled only for differing radii
    bool frozen;               ///< particles of infinite mass are present
    bool resting;              ///< particles at rest may be skipped
    bool several;              ///< several kinds of particles
    bool skips;                ///< particles that are not advanced are skipped by a list, unless they are few
    bool clumps;               ///< clumps are present, or may be added
    /// Returns whether the kernel allows for particles that are not advanced.
    [[nodiscard]] constexpr bool holds() const { return unequal || frozen || resting || several || clumps; }
};

[[nodiscard]] const Kernels& baseline_kernels(const Needs&);
[[nodiscard]] const Kernels& avx2_kernels(const Needs&);
[[nodiscard]] const Kernels& avx512_kernels(const Needs&);

}  // namespace grainsweep::dem::fast
