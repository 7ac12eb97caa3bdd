; even_1 = |wire 3@0|
; even_2 = |wire 4@0|
; even_4 = |wire 5@0|
; even_unsigned = |wire 6@0|
; even_to_signed = |wire 7@0|
; even_to_unsigned = |wire 8@0|
; even_proved = |wire 9@0|
; even_wrapped = |wire 10@0|
; even_bit = |wire 11@0|
; even_wide = |wire 12@0|
; even_wide_unsigned = |wire 13@0|
; even_unsigned_same = |wire 14@0|
; even_of_less = |wire 15@0|
; floor = |wire 16@0|
; floor_wrapped = |wire 17@0|
; floor_saturated = |wire 18@0|
; floor_wide = |wire 19@0|
; floor_of_less = |wire 20@0|
; saturated = |wire 21@0|
; saturated_bit = |wire 22@0|
; saturated_unsigned = |wire 23@0|
; saturated_same = |wire 24@0|
; saturated_wide = |wire 25@0|
; positive = |wire 26@0|
; positive_same = |wire 27@0|
; positive_wide = |wire 28@0|
; to_signed = |wire 29@0|
; to_signed_wide = |wire 30@0|
; shifted = |wire 31@0|
; shifted_wide = |wire 32@0|
; shifted_wrapped = |wire 33@0|
; shifted_off = |wire 34@0|
; shifted_proved = |wire 35@0|
; low = |wire 36@0|
; extended = |wire 37@0|
; extended_unsigned = |wire 38@0|
(declare-const |s@0| (_ BitVec 8))
(define-fun |wire 3@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r (bvashr (bvadd ((_ sign_extend 4) |s@0|) (_ bv0 12) (bvand (bvashr ((_ sign_extend 4) |s@0|) (_ bv1 12)) (_ bv1 12))) (_ bv1 12)))) (ite (bvslt r (_ bv4080 12)) (_ bv4080 12) (ite (bvslt (_ bv15 12) r) (_ bv15 12) r)))))
(define-fun |wire 4@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r (bvashr (bvadd ((_ sign_extend 5) |s@0|) (_ bv1 13) (bvand (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13)))) (ite (bvslt r (_ bv8176 13)) (_ bv8176 13) (ite (bvslt (_ bv15 13) r) (_ bv15 13) r)))))
(define-fun |wire 5@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r (bvashr (bvadd ((_ sign_extend 7) |s@0|) (_ bv7 15) (bvand (bvashr ((_ sign_extend 7) |s@0|) (_ bv4 15)) (_ bv1 15))) (_ bv4 15)))) (ite (bvslt r (_ bv32752 15)) (_ bv32752 15) (ite (bvslt (_ bv15 15) r) (_ bv15 15) r)))))
(declare-const |u@0| (_ BitVec 8))
(define-fun |wire 6@0| () (_ BitVec 3) ((_ extract 2 0) (let ((r (bvashr (bvadd ((_ zero_extend 5) |u@0|) (_ bv1 13) (bvand (bvashr ((_ zero_extend 5) |u@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13)))) (ite (bvslt r (_ bv0 13)) (_ bv0 13) (ite (bvslt (_ bv7 13) r) (_ bv7 13) r)))))
(define-fun |wire 7@0| () (_ BitVec 3) ((_ extract 2 0) (let ((r (bvashr (bvadd ((_ zero_extend 5) |u@0|) (_ bv1 13) (bvand (bvashr ((_ zero_extend 5) |u@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13)))) (ite (bvslt r (_ bv8188 13)) (_ bv8188 13) (ite (bvslt (_ bv3 13) r) (_ bv3 13) r)))))
(define-fun |wire 8@0| () (_ BitVec 3) ((_ extract 2 0) (let ((r (bvashr (bvadd ((_ sign_extend 5) |s@0|) (_ bv1 13) (bvand (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13)))) (ite (bvslt r (_ bv0 13)) (_ bv0 13) (ite (bvslt (_ bv7 13) r) (_ bv7 13) r)))))
(define-fun |wire 9@0| () (_ BitVec 6) ((_ extract 5 0) (bvashr (bvadd ((_ sign_extend 5) |s@0|) (_ bv1 13) (bvand (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13))))
(define-fun |wire 10@0| () (_ BitVec 4) ((_ extract 3 0) (bvashr (bvadd ((_ sign_extend 5) |s@0|) (_ bv1 13) (bvand (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13))))
(define-fun |wire 11@0| () (_ BitVec 1) ((_ extract 0 0) (bvashr (bvadd ((_ zero_extend 5) |u@0|) (_ bv1 13) (bvand (bvashr ((_ zero_extend 5) |u@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13))))
(define-fun |wire 12@0| () (_ BitVec 9) ((_ extract 8 0) (bvashr (bvadd ((_ sign_extend 6) |s@0|) (_ bv1 14) (bvand (bvashr ((_ sign_extend 6) |s@0|) (_ bv2 14)) (_ bv1 14))) (_ bv2 14))))
(define-fun |wire 13@0| () (_ BitVec 9) ((_ extract 8 0) (let ((r (bvashr (bvadd ((_ zero_extend 6) |u@0|) (_ bv1 14) (bvand (bvashr ((_ zero_extend 6) |u@0|) (_ bv2 14)) (_ bv1 14))) (_ bv2 14)))) (ite (bvslt r (_ bv0 14)) (_ bv0 14) (ite (bvslt (_ bv511 14) r) (_ bv511 14) r)))))
(define-fun |wire 14@0| () (_ BitVec 7) ((_ extract 6 0) (let ((r (bvashr (bvadd ((_ zero_extend 5) |u@0|) (_ bv1 13) (bvand (bvashr ((_ zero_extend 5) |u@0|) (_ bv2 13)) (_ bv1 13))) (_ bv2 13)))) (ite (bvslt r (_ bv0 13)) (_ bv0 13) (ite (bvslt (_ bv127 13) r) (_ bv127 13) r)))))
(declare-const |one@0| (_ BitVec 2))
(define-fun |wire 15@0| () (_ BitVec 4) ((_ extract 3 0) (let ((r (bvashr (bvadd ((_ sign_extend 8) |one@0|) (_ bv3 10) (bvand (bvashr ((_ sign_extend 8) |one@0|) (_ bv3 10)) (_ bv1 10))) (_ bv3 10)))) (ite (bvslt r (_ bv1016 10)) (_ bv1016 10) (ite (bvslt (_ bv7 10) r) (_ bv7 10) r)))))
(define-fun |wire 16@0| () (_ BitVec 6) ((_ extract 5 0) (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13))))
(define-fun |wire 17@0| () (_ BitVec 3) ((_ extract 2 0) (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13))))
(define-fun |wire 18@0| () (_ BitVec 3) ((_ extract 2 0) (let ((r (bvashr ((_ sign_extend 5) |s@0|) (_ bv2 13)))) (ite (bvslt r (_ bv8188 13)) (_ bv8188 13) (ite (bvslt (_ bv3 13) r) (_ bv3 13) r)))))
(define-fun |wire 19@0| () (_ BitVec 9) ((_ extract 8 0) (bvashr ((_ sign_extend 6) |s@0|) (_ bv2 14))))
(define-fun |wire 20@0| () (_ BitVec 2) ((_ extract 1 0) (bvashr ((_ sign_extend 6) |one@0|) (_ bv3 8))))
(define-fun |wire 21@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r ((_ sign_extend 3) |s@0|))) (ite (bvslt r (_ bv2032 11)) (_ bv2032 11) (ite (bvslt (_ bv15 11) r) (_ bv15 11) r)))))
(define-fun |wire 22@0| () (_ BitVec 1) ((_ extract 0 0) (let ((r ((_ sign_extend 3) |s@0|))) (ite (bvslt r (_ bv2047 11)) (_ bv2047 11) (ite (bvslt (_ bv0 11) r) (_ bv0 11) r)))))
(define-fun |wire 23@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r ((_ zero_extend 3) |u@0|))) (ite (bvslt r (_ bv0 11)) (_ bv0 11) (ite (bvslt (_ bv31 11) r) (_ bv31 11) r)))))
(define-fun |wire 24@0| () (_ BitVec 8) ((_ extract 7 0) (let ((r ((_ zero_extend 3) |u@0|))) (ite (bvslt r (_ bv1920 11)) (_ bv1920 11) (ite (bvslt (_ bv127 11) r) (_ bv127 11) r)))))
(define-fun |wire 25@0| () (_ BitVec 10) ((_ extract 9 0) (let ((r ((_ sign_extend 5) |s@0|))) (ite (bvslt r (_ bv7680 13)) (_ bv7680 13) (ite (bvslt (_ bv511 13) r) (_ bv511 13) r)))))
(define-fun |wire 26@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r ((_ sign_extend 3) |s@0|))) (ite (bvslt r (_ bv0 11)) (_ bv0 11) (ite (bvslt (_ bv31 11) r) (_ bv31 11) r)))))
(define-fun |wire 27@0| () (_ BitVec 7) ((_ extract 6 0) (let ((r ((_ sign_extend 3) |s@0|))) (ite (bvslt r (_ bv0 11)) (_ bv0 11) (ite (bvslt (_ bv127 11) r) (_ bv127 11) r)))))
(define-fun |wire 28@0| () (_ BitVec 9) ((_ extract 8 0) (let ((r ((_ sign_extend 4) |s@0|))) (ite (bvslt r (_ bv0 12)) (_ bv0 12) (ite (bvslt (_ bv511 12) r) (_ bv511 12) r)))))
(define-fun |wire 29@0| () (_ BitVec 5) ((_ extract 4 0) (let ((r ((_ zero_extend 3) |u@0|))) (ite (bvslt r (_ bv2032 11)) (_ bv2032 11) (ite (bvslt (_ bv15 11) r) (_ bv15 11) r)))))
(define-fun |wire 30@0| () (_ BitVec 10) ((_ extract 9 0) (let ((r ((_ zero_extend 5) |u@0|))) (ite (bvslt r (_ bv7680 13)) (_ bv7680 13) (ite (bvslt (_ bv511 13) r) (_ bv511 13) r)))))
(define-fun |wire 31@0| () (_ BitVec 6) ((_ extract 5 0) (let ((r (bvshl ((_ sign_extend 5) |s@0|) (_ bv2 13)))) (ite (bvslt r (_ bv8160 13)) (_ bv8160 13) (ite (bvslt (_ bv31 13) r) (_ bv31 13) r)))))
(define-fun |wire 32@0| () (_ BitVec 12) ((_ extract 11 0) (let ((r (bvshl ((_ sign_extend 9) |s@0|) (_ bv2 17)))) (ite (bvslt r (_ bv129024 17)) (_ bv129024 17) (ite (bvslt (_ bv2047 17) r) (_ bv2047 17) r)))))
(define-fun |wire 33@0| () (_ BitVec 6) ((_ extract 5 0) (bvshl ((_ sign_extend 5) |s@0|) (_ bv2 13))))
(define-fun |wire 34@0| () (_ BitVec 2) ((_ extract 1 0) (bvshl ((_ sign_extend 5) |s@0|) (_ bv2 13))))
(define-fun |wire 35@0| () (_ BitVec 10) ((_ extract 9 0) (bvshl ((_ sign_extend 7) |s@0|) (_ bv2 15))))
(define-fun |wire 36@0| () (_ BitVec 4) ((_ extract 3 0) ((_ sign_extend 3) |s@0|)))
(define-fun |wire 37@0| () (_ BitVec 11) ((_ extract 10 0) (bvshl ((_ sign_extend 7) |s@0|) (_ bv1 15))))
(define-fun |wire 38@0| () (_ BitVec 11) ((_ extract 10 0) (bvshl ((_ zero_extend 7) |u@0|) (_ bv1 15))))
