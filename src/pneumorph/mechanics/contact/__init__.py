"""Contact and friction: of a soft body with itself, with other faces, and with rigid obstacles."""

from pneumorph.mechanics.contact.contacts import Contacts
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.obstacles import Block, Cylinder, HalfSpace, Motion, Pipe, SurfaceFile
from pneumorph.mechanics.contact.part import Touch

__all__ = ["Block", "Contact", "Contacts", "Cylinder", "HalfSpace", "Motion", "Pipe", "SurfaceFile", "Touch"]
