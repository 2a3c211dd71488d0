// Contacts with walls whose shapes are made of pieces, so that a particle may touch them in several places.
//
//   list      at a rebuild: lists the pieces within the skin of each particle, its candidates
//   refresh   when a particle may have come near other candidates: selects the ones to test until the next refresh
//   find      at each step: finds the touched candidates, over lanes (wall_pieces.hpp). One piece touched inside its
//             sides is the contact. Otherwise the shape computes the contacts from the touched pieces
//
// Memories of contacts are matched by their normals (geometry/contact_memory.hpp). The laws are evaluated as for all
// other walls (wall_contacts.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/dem/fast/checkpoint.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

class WallTouches {
public:
    /// Starts with new walls, without contacts.
    void begin(Field& field, Columns& columns, const Walls& walls, const Scale& scale);
    /// Lists the particles that may touch each wall before they have moved by `reach` relative to it, in largest
    /// diameters.
    void list(const Field& field, const Walls& walls, const Scale& scale, double reach, const Parts& parts);
    /// Finds the present contacts; they keep their memories. `drift`: displacement since the lists were made.
    void find(Field& field, Columns& columns, const Walls& walls, const Kernels& kernels, const Scale& scale,
              double drift, const Parts& parts);
    /// Passage of a centre through a wall without an inside, which would then push it onwards. It is found after the
    /// step that ended at `time`, among the contacts of find(): the centre is no farther from the wall than `moved`,
    /// the largest relative displacement of the step.
    struct Passage {
        std::int32_t particle, wall;
    };
    [[nodiscard]] std::optional<Passage> passage(const Field& field, const Walls& walls, const Scale& scale,
                                                 double time, double moved, double smallest_radius) const;
    /// Renumbers particles by columns.place after sorting; contacts of removed particles end.
    void reorder(Field& field, Columns& columns);

    /// Passes the complete state to an archive; memories are in columns.touch_memory.
    template <class Archive>
    static void pass(auto& self, Archive& archive, auto& columns) {
        archive.list(self.segment_);
        const auto count = self.segment_.empty() ? 0 : static_cast<std::size_t>(self.segment_.back().end);
        archive.column(columns.touch_particle, count);
        for (auto& column : columns.touch_normal) archive.column(column, count);
        for (int a = 0; a < columns.histories; ++a) archive.column(columns.touch_memory[a], count);
    }
    /// Returns whether this state is valid for `walls` walls and `particles` particles.
    [[nodiscard]] bool fits(const Columns& columns, std::size_t walls, std::int32_t particles) const;
    /// Restores derived data after a state was read.
    void restored(Field& field, Columns& columns, const Walls& walls, const Scale& scale, double reach);

private:
    /// Pieces of a wall, and the particles near them.
    struct PieceWall {
        std::size_t wall = 0;
        std::int32_t stride = 0;
        double margin = 0;
        double seam = 0;              // displacement of a particle until the next list, m
        std::vector<double> numbers;  // in the engine's units, in the frame of the body
        std::vector<Place> particle;  // ascending
        std::vector<std::int32_t> first, active;
        std::vector<std::uint32_t> candidate;  // a particle's active ones come first
        std::vector<double> wake;              // drift at which other candidates must be tested
    };
    /// Contact of the step before.
    struct Before {
        Place particle;
        float normal[3];
    };
    struct Spread {  // a range of before_
        std::size_t begin, end;
    };

    /// Scratch data of one part of a search.
    struct Scratch {
        std::vector<std::int32_t> from;
        std::vector<std::uint32_t> of_one;
        std::vector<geometry::Closest> places;
        std::vector<WallTouch> before, now;
        WallSegment found;  // its contacts
    };
    /// Input of all parts of a search, and the columns that they write.
    struct Search {
        const PieceWall* pieces;
        const MovingWall* wall;
        const Field* field;
        Columns* columns;
        const Scale* scale;
        std::size_t old_end;  // of the wall's contacts in before_
        // For each place in the columns: index of the particle in its part, and the piece found.
        std::int32_t* entry;
        std::uint32_t* piece;
    };

    void write_pieces(const Walls& walls, const Scale& scale);
    static void refresh(PieceWall& p, Range entries, const Field& f, const MovingWall& wall, const Scale& scale,
                        double drift);
    void find_part(const Search& search, Range entries, std::size_t old_begin, const Kernels& kernels, Scratch& own,
                   std::int32_t at) const;
    std::int32_t settle(const Search& search, Range entries, std::size_t old_begin, Scratch& own, std::int32_t begin,
                        std::int32_t found) const;
    static std::int32_t ask_shape(const Search& search, Scratch& own, Place particle, std::int32_t at);
    void inherit(const Search& search, Scratch& own, Spread before, std::int32_t begin, std::int32_t end) const;
    std::int32_t close_gaps(Columns& c, std::int32_t at, const Parts& parts);
    void publish(Field& field, Columns& columns) const;

    std::vector<PieceWall> pieced_;
    std::vector<WallSegment> segment_;  // of each wall, of the columns of touches
    // Of one call.
    std::vector<Before> before_;
    std::vector<std::int32_t> entry_;
    std::vector<std::uint32_t> piece_;
    std::vector<Scratch> scratch_;  // of each part
};

}  // namespace grainsweep::dem::fast
