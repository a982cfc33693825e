// Makes the borders between charts shorter: every cut-path becomes the shortest edge path between its two cut-nodes
// inside a band around it. Creases count as shorter than they are.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.1 mentions straightening only
// for their older method. Lloyd-Max borders follow the triangulation and the noise of a scan. Straight borders pack
// more tightly, spend fewer samples on seams, and keep flattened charts from touching themselves.
//
// In:  charts that are disks with simple borders. Out: as many such charts; changes that break a disk are left out.
// Cost: O(passes * sum of the charts' sizes). Deterministic.
#pragma once

#include "encoder/charts/chartify.h"

namespace gim {

struct StraightenChartsOptions {
    double band = 0.07;   // half-width of the band, in square roots of the smaller chart's area
    double crease = 4.0;  // a right-angled crease counts 1 / (1 + this) of its length; 0: only length counts
    int passes = 2;       // in the second, paths see each other's new places
};

void straighten_charts(const Mesh& mesh, const Topology& topology, const StraightenChartsOptions& options,
                       Chartification& charts);

}  // namespace gim
