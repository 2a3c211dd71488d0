#include "stats/random.hpp"

#include <numeric>
#include <utility>

namespace grainsweep::stats {

std::uint64_t Generator::below(std::uint64_t n) {
    const std::uint64_t excess = (0 - n) % n;  // 2^64 mod n
    std::uint64_t z = next();
    while (excess != 0 && z >= 0 - excess) z = next();
    return z % n;
}

std::vector<std::uint32_t> permutation(std::uint32_t n, Generator generator) {
    std::vector<std::uint32_t> p(n);
    std::iota(p.begin(), p.end(), 0U);
    for (std::uint32_t k = n; k-- > 1;) {
        const auto j = static_cast<std::uint32_t>(generator.below(k + 1ULL));
        std::swap(p[k], p[j]);
    }
    return p;
}

}  // namespace grainsweep::stats
