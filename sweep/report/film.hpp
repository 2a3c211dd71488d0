// A case as a film: the frames taken of a scene, packed for the player of the page (page/watch).
//
// Positions are 16-bit numbers between the ends of the film's box along each axis: their error is half of 1/65535 of
// it. Colours and slices are 8-bit numbers (0: undefined), to 1/508 of their range. The range ends at the 99.5 %
// quantile where a few values lie far beyond. Vectors are shown by their magnitude, a flow on the three planes through
// the middle of its box, between the cells beside it.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/report/table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace grainsweep::report {

struct FilmLimits {
    std::size_t spheres = 100'000;  ///< more are thinned at random, the same every time
    /// Bytes of the film as text (base64), or 8.3 per sphere and frame where that is more; columns that would go beyond
    /// are left out. Positions always stay.
    std::size_t bytes = 10'000'000;
    bool columns = true;  ///< every column of the scene; else velocity alone
};

class Film {
public:
    explicit Film(const FilmLimits& limits = {}) : limits_(limits) {}

    /// One frame, later than all before. Columns of another length than the positions: std::invalid_argument.
    void add(const Snapshot& snapshot, double time);
    [[nodiscard]] std::size_t frames() const { return times_.size(); }
    [[nodiscard]] std::size_t spheres() const { return spheres_.size(); }
    /// Anything to see: particles or a flow.
    [[nodiscard]] bool shows_anything() const { return !spheres_.empty() || !slices_.empty() || !walls_.empty(); }

    /// Returns the film: "GSF2", the length of the header (32 bits, little endian), the header (JSON, UTF-8) and the
    /// blocks, whose lengths and numbers are in the header. `about`: text on the case.
    [[nodiscard]] std::string bytes(const Json& about) const;

private:
    struct Sphere {
        double diameter = 0;
        bool mobile = true;
    };
    struct Frame {
        std::vector<std::array<float, 3>> positions;  ///< by place; NaN: not there
        std::map<std::string, std::vector<float>, std::less<>> columns;
    };
    struct Wall {
        WallSurface shape;                                          ///< as it was first
        std::size_t first = 0;                                      ///< frame
        std::vector<std::vector<std::array<double, 3>>> corners{};  ///< of each frame since, where it moves
        bool moves = false, closed = false;
    };
    struct Slice {
        std::string field, quantity;
        int component = -1;  ///< of a vector; 3: its magnitude; -1: a scalar
        std::array<std::vector<double>, 3> faces;
        std::array<std::vector<float>, 3> planes{};  ///< frame by frame
        std::size_t frames = 0;
    };

    std::vector<std::size_t> places_of(const Snapshot& snapshot);
    void add_particles(const Snapshot& snapshot);
    void add_walls(const Snapshot& snapshot);
    void add_slices(const FlowField& field);
    [[nodiscard]] Slice& slice_of(const FlowField& field, const std::string& quantity, int component);

    friend class FilmWriter;

    FilmLimits limits_;
    std::vector<double> times_;
    std::vector<Frame> frames_;
    std::vector<Sphere> spheres_;
    std::unordered_map<std::int64_t, std::size_t> place_of_;  ///< of an id; looked up, never walked through
    double kept_share_ = 1;
    std::size_t most_present_ = 0;  ///< particles at a time, thinned ones included
    std::vector<Wall> walls_;
    std::vector<Slice> slices_;
    std::map<std::string, std::string, std::less<>> units_;
    std::string length_unit_ = "m", time_unit_ = "s";
    std::array<double, 3> periods_{};
};

}  // namespace grainsweep::report
