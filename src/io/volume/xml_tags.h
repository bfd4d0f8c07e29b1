// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tags of XML one after the other, never beyond the end of the bytes. VTK's files are not quite XML, since
// raw bytes may stand in them: whoever reads the tags stops in front of these.
#ifndef EWA_SRC_XML_TAGS_H
#define EWA_SRC_XML_TAGS_H

#include <stdbool.h>
#include <stddef.h>

/// A tag; all pointers go into the text.
typedef struct ewa_xml_tag {
    const char *open; ///< the <
    const char *name;
    size_t name_bytes;
    const char *attributes, *end; ///< from behind the name to the > that ends it
    bool closing;                 ///< </name>
} ewa_xml_tag;

/// Finds the next whole tag from `*at` on and steps behind it; comments, declarations and instructions are
/// passed over. False when there is none.
bool ewa_xml_next(const char **at, const char *end, ewa_xml_tag *tag);

bool ewa_xml_is(const ewa_xml_tag *tag, const char *name);

/// Copies the value of an attribute, zero-terminated, entities as they are; false when there is none or it is
/// longer.
bool ewa_xml_attribute(const ewa_xml_tag *tag, const char *name, char *value, size_t value_bytes);

#endif
