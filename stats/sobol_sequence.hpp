// The Sobol sequence with the direction numbers of Joe & Kuo (2008), SIAM J. Sci. Comput. 30, 2635-2654, as
// Boost.Random carries them: its one user, so that its templates are compiled once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace grainsweep::stats {

/// Points in Gray-code order behind that of index 0, which is all zero.
class SobolSequence {
public:
    /// 1 to most_dimensions().
    explicit SobolSequence(std::size_t dimensions);
    SobolSequence(const SobolSequence&) = delete;
    SobolSequence& operator=(const SobolSequence&) = delete;
    ~SobolSequence();

    /// The next coordinate, those of one point after another, times 2^64.
    [[nodiscard]] std::uint64_t next();
    /// The same, over 2^64.
    [[nodiscard]] double next_fraction() { return static_cast<double>(next()) * 0x1p-64; }

    [[nodiscard]] static std::size_t most_dimensions();

private:
    struct Engine;
    std::unique_ptr<Engine> engine_;
};

}  // namespace grainsweep::stats
