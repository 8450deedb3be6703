"""Files of every kind, spoilt at random: each is read, or refused in one sentence, within bounds."""
