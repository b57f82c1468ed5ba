/* Block counting a second time: one block at the end of a line, its trains, faults and staff, after spec/block.md.

   Written by hand from the sentences BLK-1 to BLK-5 and BLK-7, not from the kernel: arrays and remainders are chosen where the
   kernel has other means. It is the twin of the Stateright models of block/single.rs: each turn of the loop is one logic cycle,
   a state is stored only between two cycles, and it has one value for each of theirs. So both must find as many states.

   Parameters, by -D: SECTIONS (1 to 5), TRAINS (1 to 3), TAIL and HOLD (sections behind a head), PASS and APART (cycles),
   BUDGET (0 to 2 faulty components). */

#define UNVERIFIED 0
#define COUNTING 1
#define CHECK_OUT_AT_ZERO 2
#define CHECK_IN_AT_MAXIMUM 3
#define CHECK_IN_STAYS_ON 4

#define EVERY ((1 << SECTIONS) - 1)
#define NO_RESET 255

/* The trains, the foremost first: 0 not there, 1 in the section at the entry, SECTIONS + 1 and more beyond the exit. */
byte head[TRAINS];
byte since = APART;             /* cycles since the last entry */
bool left;                      /* a train was over the check-out */

/* The faulty components: each is free to fail in every cycle. */
byte deaf, ghostly;             /* detectors that miss a head, and that hear one that is not there: a bit for each section */
bool check_in_stuck, check_in_lost, check_out_lost, check_out_spurious, wrong_staff;

/* The machine. */
byte count;
byte check_in_for;                    /* cycles with the check-in on */
bool check_out_before = true;
byte status = UNVERIFIED;
bool agree;

/* What was seen of it. */
bool agreement_lost, endangered;

/* Chosen in a cycle, and 0 again at its end. */
byte moves, heard, number, budget;
bool entering, leaving, check_in, check_out;

/* Of the calculation alone, and 0 again at its end. (`hidden` would keep them out of the state, but not on several cores.) */
byte i, k, section, asked, c1, reported, behind, exit_hold, due;
bool agreed, rising_in, rising_out;

#define place(t) (head[t] + (moves >> (t) & 1))
#define within(h) ((h) >= 1 && (h) <= SECTIONS)

#if TRAINS == 1
#define INSIDE (within(head[0]))
#define MOVED_INSIDE (within(place(0)))
#elif TRAINS == 2
#define INSIDE (within(head[0]) + within(head[1]))
#define MOVED_INSIDE (within(place(0)) + within(place(1)))
#else
#define INSIDE (within(head[0]) + within(head[1]) + within(head[2]))
#define MOVED_INSIDE (within(place(0)) + within(place(1)) + within(place(2)))
#endif

/* One more faulty component, if there may be one. */
#define MAY_FAIL(what) if :: true :: budget > 0 -> what; budget-- fi

/* Train t stays or advances: behind the one in front or beside it, one at a time over either end, entries APART cycles apart,
   and none over the exit in two cycles running. `free_way` is what the train in front allows. */
#define MAY_ADVANCE(t, free_way) \
	if \
	:: true \
	:: free_way && !(head[t] == 0 && (since < APART || entering)) && !(head[t] == SECTIONS && (left || leaving)) -> \
		entering = entering || head[t] == 0; \
		leaving = leaving || head[t] == SECTIONS; \
		moves = moves | 1 << t \
	fi

/* The detector of a section says what it should, or fails. */
#define DETECT(s) \
	if \
	:: true \
	:: (deaf >> (s) & 1) && (heard >> (s) & 1) || (ghostly >> (s) & 1) && !(heard >> (s) & 1) -> heard = heard ^ 1 << (s) \
	fi

inline hear() {
	i = 0;
	do
	:: i < TRAINS -> if :: within(place(i)) -> heard = heard | 1 << (place(i) - 1) :: else fi; i++
	:: else -> break
	od;
	i = 0
}

/* The heads move, and a train is gone when its tail is. What those beyond the exit ask to hold is as of before they go. */
inline advance() {
	exit_hold = 0;
	i = 0;
	do
	:: i < TRAINS ->
		head[i] = place(i);
		if
		:: head[i] > SECTIONS && HOLD + SECTIONS + 1 > head[i] && HOLD + SECTIONS + 1 - head[i] > exit_hold ->
			exit_hold = HOLD + SECTIONS + 1 - head[i]
		:: else
		fi;
		i++
	:: else -> break
	od;
	do
	:: head[0] > SECTIONS + TAIL ->
		i = 1;
		do
		:: i < TRAINS -> head[i - 1] = head[i]; i++
		:: else -> break
		od;
		head[TRAINS - 1] = 0
	:: else -> break
	od;
	if :: entering -> since = 1 :: !entering && since < APART -> since++ :: else fi;
	left = leaving
}

/* BLK-3, BLK-7: the edges, judged by the count before them. At the end of the line a check-out takes effect at once. */
inline follow_checks() {
	rising_in = check_in && check_in_for == 0;
	rising_out = check_out && !check_out_before;
	if :: check_in && check_in_for <= PASS -> check_in_for++ :: !check_in -> check_in_for = 0 :: else fi;
	check_out_before = check_out;
	if
	:: status != COUNTING
	:: status == COUNTING && check_in_for > PASS -> status = CHECK_IN_STAYS_ON
	:: status == COUNTING && check_in_for <= PASS && rising_in && count == TRAINS -> status = CHECK_IN_AT_MAXIMUM
	:: status == COUNTING && check_in_for <= PASS && !(rising_in && count == TRAINS) && rising_out && count == 0 ->
		status = CHECK_OUT_AT_ZERO
	:: else -> count = count + rising_in - rising_out
	fi
}

inline compare() {
	/* C1: the sections that detect. */
	c1 = 0;
	section = 0;
	do
	:: section < SECTIONS -> c1 = c1 + (heard >> section & 1); section++
	:: else -> break
	od;
	/* BLK-4: a reset, accepted or refused. */
	if
	:: number != NO_RESET && number == c1 && number <= TRAINS && !check_in && !check_out -> count = number; status = COUNTING
	:: number != NO_RESET && (number != c1 || number > TRAINS || check_in || check_out) -> count = 0; status = UNVERIFIED
	:: else
	fi;
	/* BLK-1, BLK-2: what is believed to be a head; BLK-5: what is held behind it, here and by the block behind. */
	agreed = status == COUNTING && count == c1;
	if :: agreed -> reported = heard :: else -> reported = EVERY fi;
	behind = (exit_hold > SECTIONS -> exit_hold - SECTIONS : 0);
	section = 0;
	k = reported;
	do
	:: section < SECTIONS ->
		if
		:: k >> section & 1 ->
			asked = 1;
			do
			:: asked <= HOLD ->
				if
				:: section >= asked -> reported = reported | 1 << (section - asked)
				:: section < asked && asked - section > behind -> behind = asked - section
				:: else
				fi;
				asked++
			:: else -> break
			od
		:: else
		fi;
		if :: section + exit_hold >= SECTIONS -> reported = reported | 1 << section :: else fi;
		section++
	:: else -> break
	od;
	agreement_lost = agreement_lost || agree && !agreed;
	agree = agreed
}

/* Every section from a head back to its tail must be reported, or asked of the block behind. */
inline look() {
	i = 0;
	do
	:: i < TRAINS ->
		k = 0;
		do
		:: head[i] > 0 && k <= TAIL ->
			if
			:: head[i] <= k -> if :: k + 1 - head[i] > behind -> endangered = true :: else fi
			:: else ->
				due = head[i] - k;
				if :: due <= SECTIONS && !(reported >> (due - 1) & 1) -> endangered = true :: else fi
			fi;
			k++
		:: else -> break
		od;
		i++
	:: else -> break
	od
}

active proctype cycles() {
	byte fault;
end:
	do
	:: atomic {
#if BUDGET > 0
		/* Only before the first cycle: the check-out counts as on, and no train was there. Each set of faults in one way. */
		check_out_before && !left && deaf + ghostly + check_in_stuck + check_in_lost + check_out_lost + check_out_spurious + wrong_staff == 0 ->
		budget = BUDGET;
		MAY_FAIL(check_in_lost = true);
		MAY_FAIL(check_in_stuck = true);
		MAY_FAIL(check_out_lost = true);
		MAY_FAIL(check_out_spurious = true);
		MAY_FAIL(wrong_staff = true);
		fault = 0;
		do
		:: fault < SECTIONS ->
			MAY_FAIL(deaf = deaf | 1 << fault);
			MAY_FAIL(ghostly = ghostly | 1 << fault);
			fault++
		:: else -> break
		od;
		fault = 0;
		budget = 0
#else
		false
#endif
	}
	:: atomic {
		!endangered ->
		MAY_ADVANCE(0, true);
#if TRAINS > 1
		MAY_ADVANCE(1, place(0) > head[1]);
#endif
#if TRAINS > 2
		MAY_ADVANCE(2, place(1) > head[2]);
#endif
		if :: check_in = entering :: check_in_lost && entering :: check_in_stuck && !entering -> check_in = true fi;
		if :: check_out = leaving :: check_out_lost && leaving :: check_out_spurious && !leaving -> check_out = true fi;
		d_step { hear() };
		DETECT(0);
#if SECTIONS > 1
		DETECT(1);
#endif
#if SECTIONS > 2
		DETECT(2);
#endif
#if SECTIONS > 3
		DETECT(3);
#endif
#if SECTIONS > 4
		DETECT(4);
#endif
		if
		:: number = NO_RESET
		:: number = MOVED_INSIDE
		:: wrong_staff && MOVED_INSIDE != 0 -> number = 0
		:: wrong_staff && MOVED_INSIDE != 1 -> number = 1
#if TRAINS > 1
		:: wrong_staff && MOVED_INSIDE != 2 -> number = 2
#endif
#if TRAINS > 2
		:: wrong_staff && MOVED_INSIDE != 3 -> number = 3
#endif
		fi;
		d_step {
			advance();
			follow_checks();
			compare();
			look();
			moves = 0; heard = 0; number = 0; entering = false; leaving = false; check_in = false; check_out = false;
			i = 0; k = 0; section = 0; asked = 0; c1 = 0; reported = 0; behind = 0; exit_hold = 0; due = 0;
			agreed = false; rising_in = false; rising_out = false
		}
	}
	od
}

/* What is claimed, by the names of the Stateright models, "-" written as "_". `never_x`: that x is found must be refuted. */
ltl valid { [] (count <= TRAINS && check_in_for <= PASS + 1 && (status != UNVERIFIED || count == 0) && (status != COUNTING || check_in_for <= PASS)) }
ltl train_reported { [] !endangered }
ltl never_train_unreported { [] !endangered }
ltl exact { [] (status != COUNTING || count == INSIDE) }
ltl no_fault { [] (status == UNVERIFIED || status == COUNTING) }
ltl never_agreement { [] !(agree && count == INSIDE && INSIDE == TRAINS) }
ltl never_available_again { [] !(agreement_lost && agree && count == INSIDE) }
