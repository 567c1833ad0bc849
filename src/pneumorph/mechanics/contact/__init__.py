"""Contact and friction: of a soft body with itself, with other faces, with rigid obstacles and free rigid bodies."""

from pneumorph.mechanics.contact.body_motion import BodyMotion
from pneumorph.mechanics.contact.contacts import Contacts
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.free_body import Frame, FreeBody
from pneumorph.mechanics.contact.obstacles import Block, Cylinder, HalfSpace, Motion, Pipe, Revolved, SurfaceFile
from pneumorph.mechanics.contact.part import Touch

__all__ = [
    "Block", "BodyMotion", "Contact", "Contacts", "Cylinder", "Frame", "FreeBody", "HalfSpace", "Motion", "Pipe",
    "Revolved", "SurfaceFile", "Touch",
]  # fmt: skip
