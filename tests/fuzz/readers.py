"""All readers that are fuzzed, and how many inputs they get in all."""

from tests.fuzz import meshes, specimens, studies

TOTAL = 12_000
READERS = (*studies.READERS, *specimens.READERS, *meshes.READERS)
