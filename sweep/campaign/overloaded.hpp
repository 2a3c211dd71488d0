// Several lambdas as one visitor of a variant.
#pragma once

namespace grainsweep::campaign {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

}  // namespace grainsweep::campaign
