// Identity of a campaign read back from the JSON of the database and from the texts of an older one.
#pragma once

#include "sweep/campaign/stored_identity.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests {

/// Returns the identity read from JSON; the one read from texts must be equal.
inline campaign::Identity stored_both_ways(const campaign::Identity& identity) {
    campaign::Identity old{.name = identity.name,
                           .scene = identity.scene,
                           .revision = identity.revision,
                           .seed = identity.seed,
                           .condition = identity.condition,
                           .design = identity.design};
    campaign::read_texts(old, campaign::texts_of(identity));
    const auto text = campaign::resolved_text(identity);
    EXPECT_EQ(campaign::resolved_text(old), text);
    auto read = campaign::read_resolved(text);
    EXPECT_EQ(campaign::resolved_text(read), text);
    EXPECT_EQ(read.factors, old.factors);
    EXPECT_EQ(campaign::family_of(read), campaign::family_of(identity));
    return read;
}

}  // namespace grainsweep::tests
