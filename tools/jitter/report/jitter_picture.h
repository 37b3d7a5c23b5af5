// SPDX-License-Identifier: Apache-2.0
// jitter_picture.h - the histograms of a run as a picture: both axes logarithmic, so that the one
// tick in a million is as visible as the median.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter {

/// Buckets of the picture, 20 in a decade from 0.1 us on: from_us, then the samples of each series.
std::string make_histogram_csv(const JitterResult& result);

/// histogram.csv and histogram.svg, .png, .gp in a folder. Returns the picture's paths.
model::Result<std::vector<std::string>> draw_histogram(const JitterResult& result,
                                                       const std::string& directory);

}  // namespace tact::tools::jitter
