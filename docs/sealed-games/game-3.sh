mgt-rig table --rig random --seed 843241 --hide 1 --seal game-3.sealed -o game-3.csv
