"""Everything beneath the browser: skeletons in, taught robot out; headless and deterministic."""
