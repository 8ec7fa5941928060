"""What is handed out: the archive of sources and the wheel, as files and as they are installed."""
