#include "viewer/document/report_rows.h"

#include <fmt/format.h>

#include "grammar/rules/value.h"

namespace sgm::document {

std::vector<ReportRow> reportRows(const derive::Derivation& derivation) {
    std::vector<ReportRow> rows;
    for (uint32_t i = 0; i < derivation.grammar->reports.size(); ++i) {
        const rules::Report& report = derivation.grammar->reports[i];
        const derive::Reported told = derivation.reported(i);
        const auto text = [&](double number) {
            rules::Value value = report.like;
            value.n[0] = number;
            return rules::toText(value);
        };
        rows.push_back({report.name, text(told.sum),
                        told.count == 0 ? std::string("no shape reports it")
                                        : fmt::format("{} shapes, from {} to {}", told.count, text(told.least),
                                                      text(told.greatest))});
    }
    return rows;
}

}  // namespace sgm::document
