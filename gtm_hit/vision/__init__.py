"""People in pictures before anybody marks them: found, put on the ground, linked, missed. No Django here."""
