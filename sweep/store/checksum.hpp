// Checksums over what is stored, so that a damaged byte is found and never read as data.
//
// A checksum is the XXH3 64-bit hash of canonical bytes: every value with its type, numbers as eight bytes, -0 as 0,
// NaN as absent (as SQLite stores them). The rows of an answer or of a table are summed, modulo 2^64, so that their
// order does not matter and rows can be added.
#pragma once

#include "sweep/store/database.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::store {

/// Values in the order they are added.
class Digest {
public:
    Digest& add(std::int64_t whole);
    Digest& add(double real);
    Digest& add(std::string_view text);
    Digest& add(const SqlValue& cell);
    template <class T>
    Digest& add(const std::optional<T>& value) {
        return value ? add(*value) : absent();
    }
    Digest& absent();
    [[nodiscard]] std::uint64_t value() const;
    void clear() { bytes_.clear(); }

private:
    Digest& put(char type, const void* bytes, std::size_t size);
    std::string bytes_;
};

/// What a case measured. The second sum weighs every row by its observable: where one observable is damaged, the two
/// differences tell which.
struct MeasuredSum {
    std::uint64_t plain = 0, by_observable = 0;

    static std::uint64_t hash_of(std::string_view observable);
    static std::uint64_t weight_of(std::uint64_t observable_hash) { return observable_hash | 1U; }
    void add(std::uint64_t observable_hash, std::int64_t sample, double time, double bin, double value);
};

/// Of a case besides what it measured.
[[nodiscard]] std::uint64_t checksum_of_case(std::int64_t key, std::string_view id, std::string_view outcome,
                                             double wall_seconds);

/// A finished attempt.
struct AttemptRow {
    std::int64_t key = 0, number = 0, provenance = 0, computer = 0;
    std::string_view started = {}, outcome = {};
    std::optional<std::string_view> message = {};
    double wall_seconds = 0, cpu_seconds = 0, particle_steps = 0;
    std::optional<std::string_view> phases = {};
    /// NaN: not known. Then no part of the checksum, which is what it was before there was such a column.
    double threads = std::numeric_limits<double>::quiet_NaN();
};
[[nodiscard]] std::uint64_t checksum_of(const AttemptRow& attempt);

/// Number of rows and the sum of their digests.
struct RowSum {
    std::int64_t rows = 0;
    std::uint64_t sum = 0;

    void add(std::uint64_t row) { ++rows, sum += row; }
    void remove(const RowSum& other) { rows -= other.rows, sum -= other.sum; }
    void add(const RowSum& other) { rows += other.rows, sum += other.sum; }
    bool operator==(const RowSum&) const = default;
};

/// One place of a design.
[[nodiscard]] std::uint64_t checksum_of_place(std::int64_t point, std::int64_t replicate, std::int64_t sequence,
                                              std::int64_t case_key);

/// SQL keeps signed numbers.
[[nodiscard]] inline std::int64_t as_sql(std::uint64_t checksum) {
    return static_cast<std::int64_t>(checksum);
}

}  // namespace grainsweep::store
