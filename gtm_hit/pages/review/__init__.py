"""The reviewer's pages: the queue, the desk, and appeals."""
