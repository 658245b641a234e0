"""Results for programs to read: JSON, CSV and Parquet."""
