"""Results: forces of joints, internal forces of beams, probes, and the answer sheet of every station."""
