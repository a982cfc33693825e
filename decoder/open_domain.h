// What gim_domain is, for the C interfaces of gim/refine.h and gim/clusters.h.
#pragma once

#include "decoder/refine/quad_domain.h"
#include "gim/refine.h"

struct gim_domain {
    gim::QuadDomain domain;
};
