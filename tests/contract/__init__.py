"""Promises to users at commit 3c78333, and the tests that hold the program to them."""
