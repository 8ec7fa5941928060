"""A mechanism as it stands at its stations: pictures, animations, and files for ParaView."""
