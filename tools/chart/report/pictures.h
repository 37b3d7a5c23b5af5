// SPDX-License-Identifier: Apache-2.0
// pictures.h - the chart as a picture: force error over time per tick, of the peak and of the own
// force at its worst, and shape error below.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/report/table.h"

namespace tact::tools::chart {

/// Draws chart.svg and chart.png of a whole table; returns their paths and those of the data.
model::Result<std::vector<std::string>> draw_chart(const report::Table& table,
                                                   const std::string& title,
                                                   const std::string& directory);

}  // namespace tact::tools::chart
