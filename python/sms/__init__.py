"""Pneumatic motion platform: its equations, and what measured data says about them."""
