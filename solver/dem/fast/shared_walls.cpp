#include "solver/dem/fast/shared_walls.hpp"

#include <algorithm>
#include <bit>

namespace grainsweep::dem::fast {

namespace {

// Vectors for each part, at least: fewer take no longer than the threads need to begin and end a round.
constexpr std::int32_t vectors_worth_sharing = 4;

void add_sums(WallSums& to, const WallSums& sums) {
    for (int a = 0; a < 3; ++a) {
        to.force[a] += sums.force[a];
        to.torque[a] += sums.torque[a];
    }
    to.power += sums.power;
}

}  // namespace

/// Particles of several kinds are added up kind by kind within a tile: such sums stay on one thread.
bool SharedWalls::is_shared(const Field& f, std::int32_t wall, const Kernels& kernels, int parts) const {
    const std::int32_t vectors = (f.segments[wall].end - f.segments[wall].begin) / kernels.width;
    return parts > 1 && vectors >= vectors_worth_sharing * parts && (f.kinds <= 1 || f.walls[wall].summed == 0);
}

/// Finds the beginnings and ends of the kernel's tiles.
void SharedWalls::find_tiles(const Field& f, std::int32_t wall, const Kernels& kernels, const Parts& parts) {
    const auto [begin, end] = f.segments[wall];
    const std::int32_t width = kernels.width, vectors = (end - begin) / width;
    touching_.resize(std::max(touching_.size(), static_cast<std::size_t>(vectors)));
    parts.run_shares(vectors, [&, first = begin](Range range) {
        kernels.touching(f, wall, {first + range.begin * width, first + range.end * width},
                         touching_.data() + range.begin);
    });
    tiles_.clear();
    for (std::int32_t v = 0; v < vectors;) {
        const std::int32_t from = v;
        for (int packed = 0; v < vectors && v - from < listed_vectors && packed < wall_tile; ++v)
            packed += std::popcount(static_cast<unsigned>(touching_[static_cast<std::size_t>(v)]));
        tiles_.push_back({begin + from * width, begin + v * width});
    }
}

void SharedWalls::press(const Field& whole, const Kernels& kernels, const Walls& walls, const Subdomains& subdomains,
                        Tally& tally) {
    const Parts parts = subdomains.parts();
    const int count = parts.count();
    tallies_.assign(static_cast<std::size_t>(count), Tally{});
    for (std::int32_t w = 0; w < whole.wall_count; ++w) {
        whole.wall_sums[w] = {};
        if (!is_shared(whole, w, kernels, count)) {
            const bool listed = walls.is_single(static_cast<std::size_t>(w));
            kernels.walls(whole, w, listed ? whole.segments[w] : whole.touched[w], tally, whole.wall_sums[w]);
            continue;
        }
        if (whole.walls[w].summed != 0) {
            find_tiles(whole, w, kernels, parts);
        } else {
            const auto [begin, end] = whole.segments[w];
            tiles_.clear();
            for (int part = 0; part < count; ++part) {
                const Range share = parts.share(part, end - begin, kernels.width);
                tiles_.push_back({begin + share.begin, begin + share.end});
            }
        }
        sums_.assign(tiles_.size(), WallSums{});
        parts.run([&](int part) {
            Field f = whole;
            f.wall_filler = subdomains.filler(part);
            const Range mine = parts.share(part, static_cast<std::int32_t>(tiles_.size()));
            Tally& own = tallies_[static_cast<std::size_t>(part)];
            for (auto t = static_cast<std::size_t>(mine.begin); t < static_cast<std::size_t>(mine.end); ++t)
                kernels.walls(f, w, tiles_[t], own, sums_[t]);
        });
        for (const WallSums& sums : sums_) add_sums(whole.wall_sums[w], sums);
    }
    for (const Tally& own : tallies_) tally.wall_overlap = std::max(tally.wall_overlap, own.wall_overlap);
}

}  // namespace grainsweep::dem::fast
