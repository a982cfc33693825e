// Makes the borders between charts shorter: every cut-path becomes the shortest edge path between its two cut-nodes
// inside a band around it, creases counting as shorter than they are.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003, section 4.1 speaks of straightening for
// their older method only. Lloyd-Max borders follow the triangulation and the noise of a scan: straight ones pack more
// tightly, spend fewer samples on seams, and keep flattened charts from touching themselves.
//
// In:  charts that are disks with simple borders. Out: the same number of charts, still such disks (a change that would
//      break one is left out). Cost: O(passes * sum of the charts' sizes). Deterministic.
#pragma once

#include "encoder/charts/chartify.h"

namespace gim {

struct StraightenChartsOptions {
    double band = 0.07;   // half-width of the band, in square roots of the smaller chart's area
    double crease = 4.0;  // a right-angled crease counts 1 / (1 + this) of its length; 0: length alone
    int passes = 2;       // paths see each other's new places in the second
};

void straighten_charts(const Mesh& mesh, const Topology& topology, const StraightenChartsOptions& options,
                       Chartification& charts);

}  // namespace gim
