; T-ATC-8 over all real numbers: a distance that is long enough for two brakes is long enough for every brake between them.
;
; The distance of a code c for a brake b and an age a is (c + b·a)² / 2b: a sum of c²/2b, which falls with b, and of b·a²/2, which rises. Between
; two brakes it is never above the greater of their two distances. `proofs/src/interlocking/room.rs` says the same of whole numbers.

(declare-const age Real)
(declare-const code Real)
(declare-const weaker Real)
(declare-const between Real)
(declare-const stronger Real)
; Twice the distance.
(declare-const twice Real)

(define-fun square ((x Real)) Real (* x x))
(define-fun holds ((brake Real)) Bool (<= (square (+ code (* brake age))) (* brake twice)))
(define-fun numbers () Bool (and (<= 0.0 age) (<= 0.0 code) (< 0.0 weaker) (<= weaker between) (<= between stronger)))

; claim Between
(define-fun Between.if () Bool (and numbers (holds weaker) (holds stronger)))
(define-fun Between.then () Bool (holds between))

; cover Weaker
(define-fun Weaker.if () Bool (and Between.if (< weaker between)
  (= twice (/ (square (+ code (* weaker age))) weaker)) (< (square (+ code (* between age))) (* between twice))))

; cover Stronger
(define-fun Stronger.if () Bool (and Between.if (< between stronger)
  (= twice (/ (square (+ code (* stronger age))) stronger)) (< (square (+ code (* between age))) (* between twice))))

; cover Enough
(define-fun Enough.if () Bool (and Between.if (< weaker between stronger) (> twice 0.0)
  (> (square (+ code (* between age))) (* between (- twice 1.0)))))
