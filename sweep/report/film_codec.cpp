#include "sweep/report/film_codec.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>
#include <vector>

namespace grainsweep::report {
namespace {

constexpr std::size_t group = 32;
constexpr unsigned most_zeros = 24, raw_bits = 17, as_predicted = 31, largest_parameter = 16;

class BitWriter {
public:
    void put(std::uint32_t value, unsigned bits) {
        hold_ |= static_cast<std::uint64_t>(value) << held_;
        held_ += bits;
        for (; held_ >= 8; held_ -= 8, hold_ >>= 8U) bytes_.push_back(static_cast<char>(hold_ & 0xFFU));
    }
    std::string finish() {
        if (held_ > 0) bytes_.push_back(static_cast<char>(hold_ & 0xFFU));
        return std::move(bytes_);
    }

private:
    std::uint64_t hold_ = 0;
    unsigned held_ = 0;
    std::string bytes_;
};

std::uint32_t folded(std::int32_t rest) {
    return rest >= 0 ? 2 * static_cast<std::uint32_t>(rest) : 2 * static_cast<std::uint32_t>(-(rest + 1)) + 1;
}

unsigned cost(std::uint32_t z, unsigned k) {
    const std::uint32_t zeros = z >> k;
    return zeros < most_zeros ? zeros + 1 + k : most_zeros + 1 + raw_bits;
}

void write_items(BitWriter& out, std::span<const std::uint32_t> items) {
    if (std::ranges::all_of(items, [](std::uint32_t z) { return z == 0; })) return out.put(as_predicted, 5);
    std::uint64_t sum = 0;
    for (const auto z : items) sum += z;
    const auto guess = static_cast<unsigned>(std::bit_width(sum / items.size()));
    unsigned best = 0;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (unsigned k = guess > 2 ? guess - 2 : 0; k <= std::min(guess + 1, largest_parameter); ++k) {
        std::uint64_t bits = 0;
        for (const auto z : items) bits += cost(z, k);
        if (bits < least) least = bits, best = k;
    }
    out.put(best, 5);
    for (const auto z : items) {
        const std::uint32_t zeros = z >> best;
        if (zeros < most_zeros) {
            out.put(1U << zeros, zeros + 1);
            out.put(z & ((1U << best) - 1), best);
        } else {
            out.put(1U << most_zeros, most_zeros + 1);
            out.put(z, raw_bits);
        }
    }
}

}  // namespace

std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items) {
    if (items == 0 || values.size() % items != 0) {
        if (values.empty()) return {};
        throw std::invalid_argument("a column of a film is no whole number of frames");
    }
    BitWriter out;
    std::array<std::vector<std::uint32_t>, 3> rests;
    for (auto& rest : rests) rest.resize(items);
    for (std::size_t start = 0; start < values.size(); start += items) {
        const std::size_t frames_before = start / items;
        const auto ways = static_cast<unsigned>(std::min<std::size_t>(frames_before + 1, 3));
        std::array<std::uint64_t, 3> left{};
        for (std::size_t i = 0; i < items; ++i) {
            const std::int32_t x = values[start + i];
            std::array<std::int32_t, 3> predicted{i == 0 ? 0 : values[start + i - 1], 0, 0};
            if (ways > 1) predicted[1] = values[start - items + i];
            if (ways > 2) predicted[2] = std::clamp(2 * predicted[1] - values[start - 2 * items + i], 0, 65535);
            for (unsigned way = 0; way < ways; ++way) {
                rests[way][i] = folded(x - predicted[way]);
                left[way] += rests[way][i];
            }
        }
        const auto way = static_cast<unsigned>(std::min_element(left.begin(), left.begin() + ways) - left.begin());
        out.put(way, 2);
        for (std::size_t i = 0; i < items; i += group)
            write_items(out, std::span(rests[way]).subspan(i, std::min(group, items - i)));
    }
    return out.finish();
}

}  // namespace grainsweep::report
