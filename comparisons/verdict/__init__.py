"""The verdict on two independent answers: AGREE, DIFFER or UNDECIDED, with a reason and a stated uncertainty."""
