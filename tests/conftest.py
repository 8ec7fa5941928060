"""What every test runs under."""

from hypothesis import settings

# an example takes as long as the machine's other work lets it
settings.register_profile("no clock", deadline=None)
settings.load_profile("no clock")
