// How sure it is how heads are turned: sensors that see nose, eyes and ears tell it of the head,
// but not with what doubt.
//
// The covariance of a fused head's orientation is that of one view's marks (posture::kHeadTurn),
// which is not divided by the number of views, because networks err alike, and beside it the mean
// square of how far the views' orientations are from the fused one.
#pragma once

#include <vector>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"

namespace chorus::pipeline {

/// Sets FusedBody::orientation_covariance of heads whose orientation views tell and that have none.
void state_head_turns(const std::vector<Person>& people, std::vector<FusedBody>& bodies);

}  // namespace chorus::pipeline
