//! Cases whose effect is withheld from the diagnosis, and their score.
