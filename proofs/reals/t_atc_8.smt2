; T-ATC-8 over all real numbers: a train by codes alone that has the room to stop keeps it, in whatever order codes fall and rise.
;
; The unit of time is such that the brake is 1: a time is what the brake takes off the speed in it. A room is the square of the
; speed from which the train stops within what is left; so what it runs counts twice. In these units the distance of a code c
; for an age a is (c + a)². `proofs/src/interlocking/room.rs` says the same of whole numbers.
;
; A step is of any length, and in it the speed changes evenly. A run of a train is any number of steps.

(declare-const age Real)
; A train: its speed, its room; and a code that it was told, how long ago, and when a train that brakes from here is back at
; the code at the latest, of all the places where it may have begun to brake (from now on).
(declare-const speed Real)
(declare-const room Real)
(declare-const code Real)
(declare-const since Real)
(declare-const left Real)
; The step: how long it takes, the speed behind it, what it takes of the room.
(declare-const time Real)
(declare-const next Real)
(declare-const run Real)
; Another code.
(declare-const other Real)

(define-fun square ((x Real)) Real (* x x))
(define-fun over ((speed Real) (code Real)) Real (ite (> speed code) (- speed code) 0.0))
(define-fun needed ((code Real)) Real (square (+ code age)))

; The train stops within its room, if it brakes.
(define-fun stops ((speed Real) (room Real)) Bool (>= room (square speed)))
; What is known of a train that was told a code: it is no faster than one that brakes; that one has the room to stop; and since the
; code was told it has run no more than at the code, and on top what such a train is faster.
(define-fun slower ((speed Real) (code Real) (left Real)) Bool (>= left (over speed code)))
(define-fun near ((room Real) (code Real) (left Real)) Bool (>= room (square (+ code left))))
(define-fun ran ((room Real) (code Real) (since Real) (left Real)) Bool
  (>= (+ room (* 2.0 code since) (- (square (+ since left)) (square left))) (needed code)))
(define-fun known ((speed Real) (room Real) (code Real) (since Real) (left Real)) Bool
  (and (<= 0.0 since age) (<= 0.0 left) (slower speed code left) (near room code left) (ran room code since left)))

(define-fun numbers () Bool (and (<= 0.0 age) (<= 0.0 speed) (<= 0.0 code) (<= 0.0 next) (< 0.0 time) (<= (+ since time) age)))
(define-fun before () Bool (and numbers (stops speed room) (known speed room code since left)))
(define-fun evenly () Bool (= run (* (+ speed next) time)))
; It brakes, with its brake or more; it comes to a stand in the step; it is no faster than the code that it obeys.
(define-fun brakes () Bool (and evenly (<= (+ next time) speed)))
(define-fun stands () Bool (and (= next 0.0) (<= speed time) (<= 0.0 run (square speed))))
(define-fun obeys () Bool (and evenly (<= next code)))
; It obeys another code: of that one the claims say what it does.
(define-fun else () Bool (and evenly (stops next (- room run))))
(define-fun step () Bool (or brakes stands obeys else))
; A train that brakes needs no code at all: it may have been told none, or all may be too old.
(define-fun slows () Bool
  (and (<= 0.0 speed) (<= 0.0 next) (< 0.0 time) (stops speed room) (or brakes stands)))
; When a train that brakes is back at the code, behind the step.
(define-fun later () Real (let ((rest (- left time))) (ite (> rest (over next code)) rest (over next code))))

; lemma Slow
(define-fun Slow.if () Bool slows)
(define-fun Slow.then () Bool (and (<= run room) (stops next (- room run))))

; lemma Early
; It obeys the code, and a train that brakes is not yet back at it: that one has the room, and is faster.
(define-fun Early.if () Bool (and numbers obeys (>= left time) (slower speed code left) (near room code left)))
(define-fun Early.then () Bool (and (<= run room) (stops next (- room run))))

; lemma Late
; It is no faster than the code, and a train that brakes is back at it: what it has run since the code was told leaves the code's room.
(define-fun Late.if () Bool
  (and numbers obeys (<= 0.0 since) (<= 0.0 left) (< left time) (slower speed code left) (ran room code since left)))
(define-fun Late.then () Bool (and (<= run room) (stops code (- room run)) (stops next (- room run))))

; lemma Evenly
; However it goes on evenly, if it stops behind the step.
(define-fun Evenly.if () Bool
  (and numbers evenly (stops next (- room run)) (<= 0.0 since) (<= 0.0 left)
    (slower speed code left) (near room code left) (ran room code since left)))
(define-fun Evenly.then () Bool (near (- room run) code later))

; lemma Standing
(define-fun Standing.if () Bool
  (and numbers stands (stops next (- room run)) (<= 0.0 since) (<= 0.0 left)
    (slower speed code left) (near room code left) (ran room code since left)))
(define-fun Standing.then () Bool (near (- room run) code later))

; claim Within
; It runs no farther than what is left. Of another code the claim for that one says it.
(define-fun Within.if () Bool (or slows (and before obeys)))
(define-fun Within.then () Bool (<= run room))

; claim Stops
(define-fun Stops.if () Bool (or slows (and before obeys)))
(define-fun Stops.then () Bool (stops next (- room run)))

; claim Known
(define-fun Known.if () Bool (and before step (stops next (- room run))))
(define-fun Known.then () Bool (known next (- room run) code (+ since time) later))

; claim Told
(define-fun Told.if () Bool (and (<= 0.0 age) (<= 0.0 speed) (<= 0.0 other) (stops speed room) (>= room (needed other))))
(define-fun Told.then () Bool (known speed room other 0.0 (over speed other)))

; cover Brakes
(define-fun Brakes.if () Bool (and before brakes (> next code)))

; cover Stands
(define-fun Stands.if () Bool (and before stands (> speed 0.0)))

; cover Rises
(define-fun Rises.if () Bool (and before obeys (> next speed)))

; cover Over
(define-fun Over.if () Bool (and before else (> next code) (> next speed)))

; cover Lower
(define-fun Lower.if () Bool (and Told.if (< other speed)))
