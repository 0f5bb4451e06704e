"""Measured data: tables of numbers, and values between their points."""
