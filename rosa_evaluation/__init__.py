"""What every experiment needs: scenarios, run records, and later campaigns and reports."""
