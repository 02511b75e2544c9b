"""``python -m colladaphy``."""

from colladaphy.cli import main

if __name__ == "__main__":
    main()
