"""Ratchets: measured sizes of the product packages, and falling limits."""
