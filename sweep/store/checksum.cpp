#include "sweep/store/checksum.hpp"

#include <xxhash.h>

#include <array>
#include <bit>
#include <cmath>

namespace grainsweep::store {

namespace {

/// One pattern of bits for every number that compares equal, and one for all NaN.
std::uint64_t canonical_bits(double x) {
    if (std::isnan(x)) x = std::numeric_limits<double>::quiet_NaN();
    return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
}

}  // namespace

Digest& Digest::put(char type, const void* bytes, std::size_t size) {
    bytes_ += type;
    bytes_.append(static_cast<const char*>(bytes), size);
    return *this;
}

Digest& Digest::add(std::int64_t whole) {
    return put('i', &whole, sizeof whole);
}

Digest& Digest::add(double real) {
    if (std::isnan(real)) return absent();
    const std::uint64_t bits = canonical_bits(real);
    return put('r', &bits, sizeof bits);
}

Digest& Digest::add(std::string_view text) {
    const std::uint64_t length = text.size();
    put('t', &length, sizeof length);
    bytes_ += text;
    return *this;
}

Digest& Digest::absent() {
    bytes_ += 'n';
    return *this;
}

Digest& Digest::add(const SqlValue& cell) {
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return add(*whole);
    if (const auto* real = std::get_if<double>(&cell)) return add(*real);
    if (const auto* text = std::get_if<std::string>(&cell)) return add(std::string_view(*text));
    return absent();
}

std::uint64_t Digest::value() const {
    return XXH3_64bits(bytes_.data(), bytes_.size());
}

std::uint64_t MeasuredSum::hash_of(std::string_view observable) {
    return XXH3_64bits(observable.data(), observable.size());
}

void MeasuredSum::add(std::uint64_t observable_hash, std::int64_t sample, double time, double bin, double value) {
    const std::array<std::uint64_t, 4> row = {static_cast<std::uint64_t>(sample), canonical_bits(time),
                                              canonical_bits(bin), canonical_bits(value)};
    const std::uint64_t hash = XXH3_64bits_withSeed(row.data(), sizeof row, observable_hash);
    plain += hash;
    by_observable += hash * weight_of(observable_hash);
}

std::uint64_t checksum_of_case(std::int64_t key, std::string_view id, std::string_view outcome, double wall_seconds) {
    return Digest().add(key).add(id).add(outcome).add(wall_seconds).value();
}

std::uint64_t checksum_of(const AttemptRow& attempt) {
    Digest digest;
    digest.add(attempt.key)
        .add(attempt.number)
        .add(attempt.provenance)
        .add(attempt.computer)
        .add(attempt.started)
        .add(attempt.outcome)
        .add(attempt.message)
        .add(attempt.wall_seconds)
        .add(attempt.cpu_seconds)
        .add(attempt.particle_steps)
        .add(attempt.phases);
    if (!std::isnan(attempt.threads)) digest.add(attempt.threads);
    return digest.value();
}

std::uint64_t checksum_of_place(std::int64_t point, std::int64_t replicate, std::int64_t sequence,
                                std::int64_t case_key) {
    const std::array<std::int64_t, 4> row = {point, replicate, sequence, case_key};
    return XXH3_64bits(row.data(), sizeof row);
}

}  // namespace grainsweep::store
