// Checksums of stored data, so that a damaged byte is detected and never used.
//
// A checksum is the XXH3 64-bit hash of canonical bytes: every value with its type, numbers as eight bytes, -0 as 0,
// NaN as absent (as SQLite stores them). The digests of the rows of an answer or a table are summed modulo 2^64, so
// their order does not matter and rows can be added.
#pragma once

#include "sweep/store/database.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::store {

/// Digest of values in the order of their addition.
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

/// Sums of the observables of a case. The second sum weights every row by its observable, so that the two differences
/// identify a single damaged observable.
struct MeasuredSum {
    std::uint64_t plain = 0, by_observable = 0;

    static std::uint64_t hash_of(std::string_view observable);
    static std::uint64_t weight_of(std::uint64_t observable_hash) { return observable_hash | 1U; }
    void add(std::uint64_t observable_hash, std::int64_t sample, double time, double bin, double value);
};

/// Returns the checksum of a case without its observables.
[[nodiscard]] std::uint64_t checksum_of_case(std::int64_t key, std::string_view id, std::string_view outcome,
                                             double wall_seconds);

/// Finished attempt.
struct AttemptRow {
    std::int64_t key = 0, number = 0, provenance = 0, computer = 0;
    std::string_view started = {}, outcome = {};
    std::optional<std::string_view> message = {};
    double wall_seconds = 0, cpu_seconds = 0, particle_steps = 0;
    std::optional<std::string_view> phases = {};
    /// NaN: unknown. Then it is no part of the checksum, which equals the checksum before this column existed.
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

/// Returns the checksum of a place of a design.
[[nodiscard]] std::uint64_t checksum_of_place(std::int64_t point, std::int64_t replicate, std::int64_t sequence,
                                              std::int64_t case_key);

/// Returns the checksum as a signed number, because SQL has no unsigned ones.
[[nodiscard]] inline std::int64_t as_sql(std::uint64_t checksum) {
    return static_cast<std::int64_t>(checksum);
}

}  // namespace grainsweep::store
