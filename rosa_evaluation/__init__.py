"""What every experiment needs: scenarios, run records, campaigns, statistics."""
