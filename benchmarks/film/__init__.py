"""One contact at one instant: films, dry contacts, their errors and cost."""
