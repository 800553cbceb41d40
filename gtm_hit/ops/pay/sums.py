"""What a worker of a campaign has coming, as plain arithmetic with decimals."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_HALF_UP, ROUND_UP, Decimal

CENT = Decimal("0.01")
NOTHING = Decimal("0.00")
HOUR = Decimal(3600)
SHORTEST = 60.0  # seconds; what an hour comes to cannot be told from less


@dataclass(frozen=True)
class Balance:
    """Money in one currency. `on_its_way`: the platform is, or will be, told to pay it, without an answer."""

    earned: Decimal = NOTHING
    bonus_approved: Decimal = NOTHING
    paid: Decimal = NOTHING
    on_its_way: Decimal = NOTHING

    @property
    def owed(self) -> Decimal:
        return self.earned + self.bonus_approved

    @property
    def to_pay(self) -> Decimal:
        """Never below nothing; what was paid too much is `overpaid`."""
        return max(self.owed - self.paid - self.on_its_way, NOTHING)

    @property
    def overpaid(self) -> Decimal:
        return max(self.paid + self.on_its_way - self.owed, NOTHING)


def exact(total: Decimal | None) -> Decimal:
    """A sum of the database to the cent: SQLite adds in floating point, far more exactly than that."""
    return NOTHING if total is None else total.quantize(CENT, ROUND_HALF_UP)


def hours(seconds: float) -> Decimal:
    return Decimal(str(round(seconds, 3))) / HOUR


def per_hour(owed: Decimal, seconds: float) -> Decimal | None:
    """What an hour of work came to; None when there was hardly any."""
    if seconds < SHORTEST:
        return None
    return (owed / hours(seconds)).quantize(CENT, ROUND_HALF_UP)


def bonus_to_floor(owed: Decimal, seconds: float, floor: Decimal) -> Decimal:
    """What is missing to the hourly floor, rounded up to a cent; nothing when nothing is."""
    missing = floor * hours(seconds) - owed
    return missing.quantize(CENT, ROUND_UP) if missing > 0 else NOTHING
