"""How far apart the clocks of several videos are, guessed from what they show or sound like. No Django.

Signs are those of an import of videos: a video's offset is the second in it at which the time all videos
share is 0, so that what happens at the shared time t is in the video at `offset + t * (1 + drift)`.
"""
