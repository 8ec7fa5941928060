"""Tests of promises to users: the program keeps the promises of commit 3c78333, or declares a change."""
