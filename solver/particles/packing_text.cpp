// How a packing travels: its key, its bytes, and the text a user brings.
#include "solver/bytes.hpp"
#include "solver/particles/near_pairs.hpp"
#include "solver/particles/packing.hpp"
#include "solver/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace grainsweep::particles {
namespace {

constexpr std::uint64_t packing_mark = 0x31676E696B636170;  // "packing1", first byte first
constexpr double most_overlap = 0.05;                       // more is no packing of touching spheres, or another unit
constexpr int algorithm_revision = 1;                       // grows whenever the same request packs differently

struct PackingHeader {
    std::uint64_t mark = packing_mark;
    double edge = 0;
    double largest_overlap = 0;
    std::int64_t iterations = 0;
    std::uint64_t count = 0;
};

[[noreturn]] void refuse(std::size_t line, const std::string& what) {
    throw std::invalid_argument("packing, line " + std::to_string(line) + ": " + what);
}

/// One line "x,y,z"; nothing where it is not three numbers.
std::optional<std::array<double, 3>> three_numbers(std::string_view line) {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto comma = k < 2 ? line.find(',') : line.size();
        if (comma == std::string_view::npos) return std::nullopt;
        const auto number = any_number_in(trimmed(line.substr(0, comma)));
        if (!number) return std::nullopt;
        x[k] = *number;
        line.remove_prefix(std::min(comma + 1, line.size()));
    }
    return x;
}

/// Refuses more spheres than fit into the cube around their centres, before pairs are listed: equal spheres fill at
/// most 0.7405 of space (Hales 2005).
void require_room(std::span<const std::array<double, 3>> positions) {
    constexpr std::size_t few = 1000;  // the first pair that overlaps is named
    if (positions.size() <= few) return;
    constexpr double densest = 0.7405, sphere = 0.5236 * (1 - most_overlap) * (1 - most_overlap) * (1 - most_overlap);
    double volume = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        double low = positions.front()[k], high = low;
        for (const auto& x : positions) low = std::min(low, x[k]), high = std::max(high, x[k]);
        volume *= high - low + 1;
    }
    const double most = std::floor(densest * volume / sphere);
    if (static_cast<double>(positions.size()) > most)
        throw std::invalid_argument("packing: " + std::to_string(positions.size()) + " spheres lie where at most " +
                                    shortest_text(most) +
                                    " have room, so that they overlap (coordinates are in diameters)");
}

}  // namespace

std::string packing_key(const PackingRequest& request) {
    return "packing\nalgorithm=" + std::to_string(algorithm_revision) + "\nedge=" + shortest_text(request.edge) +
           "\nfraction=" + shortest_text(request.fraction) + "\nseed=" + std::to_string(request.seed) +
           "\ntolerance=" + shortest_text(request.tolerance) + "\n";
}

std::vector<std::byte> encode(const Packing& packing) {
    const PackingHeader header{packing_mark, packing.edge, packing.largest_overlap, packing.iterations,
                               packing.positions.size()};
    std::vector<std::byte> bytes;
    append_bytes(bytes, header);
    append_bytes<std::array<double, 3>>(bytes, packing.positions);
    return bytes;
}

Packing decode_packing(std::span<const std::byte> bytes) {
    PackingHeader header;
    const bool whole = bytes.size() >= sizeof header;
    if (whole) take_bytes(bytes, header);
    constexpr std::size_t record = sizeof(std::array<double, 3>);
    if (!whole || header.mark != packing_mark || header.count != bytes.size() / record || bytes.size() % record != 0)
        throw std::invalid_argument("these bytes are no packing");
    Packing packing{header.edge, {}, header.largest_overlap, static_cast<int>(header.iterations)};
    packing.positions.resize(header.count);
    take_bytes<std::array<double, 3>>(bytes, packing.positions);
    for (const auto& x : packing.positions)
        for (const double c : x)
            if (!(c >= 0 && c <= packing.edge)) throw std::invalid_argument("these bytes are no packing");
    return packing;
}

Packing read_packing(std::string_view csv, double edge) {
    Packing packing{edge, {}, 0, 0};
    std::vector<std::size_t> line_of;
    std::size_t number = 0;
    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);  // byte-order mark
    while (!csv.empty()) {
        const auto end = std::min(csv.find('\n'), csv.size());
        const std::string_view line = trimmed(csv.substr(0, end));
        csv.remove_prefix(std::min(end + 1, csv.size()));
        ++number;
        if (number == 1) {
            if (line != "x,y,z") refuse(1, "the header must be x,y,z, not '" + std::string(line.substr(0, 40)) + "'");
            continue;
        }
        if (line.empty()) continue;
        const auto x = three_numbers(line);
        if (!x) refuse(number, "'" + std::string(line.substr(0, 60)) + "' is not three numbers with commas between");
        for (const double c : *x)
            if (!(c >= 0 && c < edge))
                refuse(number, "a centre at " + shortest_text(c) + " is outside the cube of " + shortest_text(edge) +
                                   " diameters (coordinates are in diameters)");
        packing.positions.push_back(*x);
        line_of.push_back(number);
    }
    if (packing.positions.empty()) refuse(std::max<std::size_t>(number, 1), "there is no sphere");

    require_room(packing.positions);
    for_each_near_pair(packing.positions, 1, [&](std::size_t i, std::size_t j, double r) {
        if (1 - r > most_overlap)
            refuse(line_of[j], "the sphere overlaps that of line " + std::to_string(line_of[i]) + " by " +
                                   shortest_text(1 - r) + " diameters; at most 0.05 is allowed");
        packing.largest_overlap = std::max(packing.largest_overlap, 1 - r);
    });
    return packing;
}

}  // namespace grainsweep::particles
