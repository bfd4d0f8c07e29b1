// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Comments torn as a formatter tears them that knows no lists: tools/check_comments.py has to find each.

// ---- A heading whose rule went to the next line
// ----------------------------------------------------------------

/// - An item of a list that was wrapped where the formatter thought right, which is not where the next
/// line
///   goes on.
/// - An item
///   as it should be.
///
/// | name     | meaning                                                                          |
/// |----------|----------------------------------------------------------------------------------|
/// | position | where it is, in a row that a formatter wrapped because it took it for a sentence
/// | | normal | outward                                                                        |
///
/// A line as long as the formatter lets it be, after which one word stands alone although the next line has
/// room
/// for it.
