"""What a rod is attached to, one kind per file: energies that no load factor multiplies."""

from cosserat.rods.attachments.attachment import Attachment
from cosserat.rods.attachments.foundations import Foundation
from cosserat.rods.attachments.springs import Spring

ATTACHMENTS: dict[str, type[Attachment]] = {"springs": Spring, "foundations": Foundation}
"""Kinds of attachments by their key in a case."""
