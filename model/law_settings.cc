#include "model/law_settings.h"

namespace tact::model {

std::string_view name_of(LawKind kind) {
  for (const LawName& law : kLawNames)
    if (law.kind == kind) return law.name;
  return "";
}

LawKind section_of(LawKind kind) {
  if (kind == LawKind::kRhombusPaperLiteral) return LawKind::kRhombus;
  return kind == LawKind::kHexSheetPaper ? LawKind::kHexSheet : kind;
}

}  // namespace tact::model
