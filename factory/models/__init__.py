"""Every trained thing: arrays in, arrays out; its weights and their card."""
