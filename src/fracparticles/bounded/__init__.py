"""Fractional diffusion on bounded domains, with what is outside: absorbing, reflecting or given."""
